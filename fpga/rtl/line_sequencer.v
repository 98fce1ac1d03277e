// Line sequencer: exactly slots_per_line decisions a line, and which of them lie in the marking window.
//
// A line begins on a slot that finds no line running and `start` high; the settings are taken there and kept to its end.
// The slot after the last may begin the next line: lines follow without a gap. A slots_per_line of 0 starts nothing.
// Latency: all outputs are flip-flops, one clock after `slot` (SEQUENCER_LATENCY); apart from `running` they are high
// for that clock only. Reset: idle.
`default_nettype none
module line_sequencer #(
    parameter W = 16
) (
    input wire clk,
    input wire rst,
    input wire slot,
    input wire start,
    input wire [W-1:0] slots_per_line,
    input wire [W-1:0] first_slot,
    input wire [W-1:0] window_slots,
    output reg slot_out,
    output reg decision,
    output reg window,
    output reg first,
    output reg last,
    output reg running
);
  reg [W-1:0] index;
  reg [W-1:0] line_slots;
  reg [W-1:0] line_first;
  reg [W-1:0] line_window;

  wire active = running || (start && slots_per_line != 0);
  wire [W-1:0] now_index = running ? index : {W{1'b0}};
  wire [W-1:0] now_slots = running ? line_slots : slots_per_line;
  wire [W-1:0] now_first = running ? line_first : first_slot;
  wire [W-1:0] now_window = running ? line_window : window_slots;
  wire is_last = now_index == now_slots - 1'b1;
  wire in_window = now_index >= now_first && now_index - now_first < now_window;

  always @(posedge clk) begin
    slot_out <= !rst && slot;
    decision <= 1'b0;
    window <= 1'b0;
    first <= 1'b0;
    last <= 1'b0;
    if (rst) begin
      running <= 1'b0;
      index <= 0;
      line_slots <= 0;
      line_first <= 0;
      line_window <= 0;
    end else if (slot && active) begin
      decision <= 1'b1;
      window <= in_window;
      first <= !running;
      last <= is_last;
      running <= !is_last;
      index <= now_index + 1'b1;
      line_slots <= now_slots;
      line_first <= now_first;
      line_window <= now_window;
    end
  end

`ifdef FORMAL
  reg [W:0] decisions;  // of this line, the one shown now included
  reg valid = 1'b0;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    if (rst) decisions <= 0;
    else if (slot && active) decisions <= running ? decisions + 1'b1 : {{W{1'b0}}, 1'b1};
  end
  always @(*) if (valid) begin
    if (running) assert (decisions == {1'b0, index} && index < line_slots && index != 0);
    if (last) assert (decisions == {1'b0, line_slots} && !running);  // exactly np decisions
    if (decision && !last) assert (running);
    if (first) assert (decision && decisions == 1);
    if (window || first || last) assert (decision);
    if (decision) assert (slot_out);
    if (window) assert (decisions > {1'b0, line_first} && decisions - 1'b1 - {1'b0, line_first} < {1'b0, line_window});
  end
`endif
endmodule
`default_nettype wire
