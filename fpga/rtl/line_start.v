// Line start: when slots run and when the first line may begin.
//
// timed low: slots run with `run`; lines begin at the first slot after `strobe` was seen while they do. timed high: tick 0
// is the clock after `go`; slots and lines begin together, first_tick clocks later, and `strobe` means nothing.
// A tick that was over before run rose starts nothing; go sets a new tick 0. run low stops all.
// Latency: `started` one clock after the strobe; slots_run is high first_tick + START_LATENCY clocks after the clock that takes go. Reset: standing.
`default_nettype none
module line_start #(
    parameter W = 32
) (
    input wire clk,
    input wire rst,
    input wire run,
    input wire timed,
    input wire strobe,
    input wire go,
    input wire [W-1:0] first_tick,
    output wire slots_run,
    output reg started
);
  reg counting, arrives, arrived;
  reg [W-1:0] tick;
  assign slots_run = run && (!timed || arrived);

  always @(posedge clk) begin
    if (rst) begin
      counting <= 1'b0;
      tick <= 0;
      arrives <= 1'b0;
      arrived <= 1'b0;
      started <= 1'b0;
    end else begin
      if (go) begin
        counting <= 1'b1;
        tick <= 0;
      end else if (counting) begin
        tick <= tick + 1'b1;
        if (tick == {W{1'b1}}) counting <= 1'b0;
      end
      arrives <= counting && !go && tick == first_tick;
      arrived <= run && !go && (arrived || arrives);
      started <= run && (timed ? !go && (arrived || arrives) : started || strobe);
    end
  end

`ifdef FORMAL
  /* verilator lint_off UNUSEDPARAM */
  `include "latencies.vh"
  /* verilator lint_on UNUSEDPARAM */
  // In timed mode nothing runs before its tick, and the tick starts it.
  reg valid = 1'b0;
  reg [W+1:0] since;
  reg gone = 1'b0, was_timed = 1'b0, was_run = 1'b0;
  (* anyconst *) reg [W-1:0] fixed;
  initial assume (rst);
  always @(*) assume (first_tick == fixed);
  always @(posedge clk) begin
    valid <= 1'b1;
    was_timed <= timed;
    was_run <= run;
    if (rst) gone <= 1'b0;
    else if (go) begin
      gone  <= 1'b1;
      since <= 1;
    end else if (since != {(W + 2) {1'b1}}) since <= since + 1'b1;
  end
  always @(*) if (valid) begin
    if (counting) assert (gone && since == {2'b00, tick} + 1'b1);
    if (!gone) assert (!counting && !arrives && !arrived);
    if (arrived) assert (gone && since >= {2'b00, fixed} + START_LATENCY);
    if (arrives) assert (gone && since == {2'b00, fixed} + START_LATENCY - 1);
    if (started && was_timed) assert (arrived);
    if (arrived) assert (was_run);
  end
`endif
endmodule
`default_nettype wire
