// Pulse gate: holds the laser's gate for one slot at a time, by the bits of a line, most significant first.
//
// Bytes come from a show-ahead FIFO (`byte_valid`, `byte_data`, `byte_take` pops) through one byte of prefetch. A line
// starts on a fresh byte: what is left of a line's last byte is dropped. Outside the window, outside lines and while
// `run` is low the gate is closed.
// Fails dark: `fault`, or a bit that is missing when its slot begins (`underrun`, sticky), closes the gate on that clock
// and keeps it closed until `clear`, which drops the prefetched byte too, and then until a line begins.
// passed: the decision of a slot was let through: with its bit, or closed outside the window. Those of a line are its first
// ones. open: and the next one of this line will be; low from its last.
// Latency: all outputs are flip-flops, `gate` and `passed` GATE_LATENCY after the sequencer's outputs. Reset: dark until clear.
`default_nettype none
module pulse_gate (
    input wire clk,
    input wire rst,
    input wire run,
    input wire clear,
    input wire fault,
    input wire slot,
    input wire decision,
    input wire window,
    input wire first,
    input wire last,
    input wire byte_valid,
    input wire [7:0] byte_data,
    output reg gate,
    output reg byte_take,
    output reg underrun,
    output reg dark,
    output reg passed,
    output reg open
);
  reg [7:0] bits;
  reg [3:0] left;
  reg [7:0] next;
  reg next_valid;

  wire closed = dark || fault;
  wire line_open = first || open;
  wire wanted = slot && decision && window && line_open && !closed && run;
  wire fresh = left == 0;
  wire starved = wanted && fresh && !next_valid;
  wire fetch = !next_valid && byte_valid && !byte_take;

  always @(posedge clk) begin
    byte_take <= 1'b0;
    passed <= slot && decision && line_open && !closed && !starved && run && !rst && !clear;
    if (rst || clear) begin
      gate <= 1'b0;
      open <= 1'b0;
      left <= 0;
      next_valid <= 1'b0;
      underrun <= 1'b0;
      dark <= rst || fault;
      bits <= 0;
      next <= 0;
    end else begin
      if (closed || !run) gate <= 1'b0;
      else if (slot) gate <= wanted && !starved && (fresh ? next[7] : bits[7]);
      if (fault || starved) dark <= 1'b1;
      if (starved) underrun <= 1'b1;
      if (closed || starved || !run) open <= 1'b0;
      else if (slot && decision) open <= line_open && !last;
      if (fetch) begin
        next <= byte_data;
        next_valid <= 1'b1;
        byte_take <= 1'b1;
      end
      if (wanted && !starved) begin
        bits <= fresh ? {next[6:0], 1'b0} : {bits[6:0], 1'b0};
        left <= fresh ? 4'd7 : left - 4'd1;
        if (fresh) next_valid <= 1'b0;
      end
      if (slot && decision && last) left <= 0;
    end
  end

`ifdef FORMAL
  reg valid = 1'b0;
  reg could_open, was_bad, was_slot, was_last;
  reg missed;  // a decision of this line, the one shown now included, did not pass
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    was_last <= last;
    if (slot && decision) missed <= (missed && !first) || !line_open || closed || starved || !run || rst || clear;
    could_open <= slot && decision && window && run && !fault && !dark && !rst && !clear;
    was_bad <= fault || dark || !run || rst || clear || starved;
    was_slot <= slot;
  end
  reg was_gate;
  always @(posedge clk) was_gate <= gate;
  always @(*) if (valid) begin
    if (was_bad) assert (!gate);                       // closed one clock after anything bad
    if (gate && was_slot) assert (could_open);         // opens at a decision inside the window only
    if (gate && !was_slot) assert (was_gate);          // and never between slots
    if (dark) assert (!gate);
    if (underrun) assert (dark);                       // sticky until clear
    assert (left <= 7);
    if (gate && was_slot) assert (passed);             // what fires has passed,
    if (passed) assert (was_slot && !was_bad && !missed);  // and all of the line before it
    if (passed) assert (open == !was_last);
    if (open) assert (!missed);
  end
`endif
endmodule
`default_nettype wire
