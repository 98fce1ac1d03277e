// Line sequencer: exactly slots_per_line decisions a line, and which of them lie in the marking window.
//
// A line begins on a slot that finds no line running and `start` high; the settings are taken there and kept to its end.
// The slot after the last may begin the next line: lines follow without a gap. A slots_per_line of 0 starts nothing.
// Latency: all outputs are flip-flops, SEQUENCER_LATENCY after `slot`; apart from `running` they are high
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
  // As of the line's latest slot: slots that are left with it, those before the window, and those of the window. Counted
  // down, so that only zero and one are compared with.
  reg [W-1:0] left, to_window, of_window;

  wire active = running || (start && slots_per_line != 0);
  wire last_now = running ? left == 2 : slots_per_line == 1;
  wire reached = running ? to_window[W-1:1] == 0 : first_slot == 0;  // the window, or what comes after it
  wire entered = running && to_window == 0;                          // by an earlier slot
  wire more = running ? of_window != 0 && !(entered && of_window == 1) : window_slots != 0;

  always @(posedge clk) begin
    slot_out <= !rst && slot;
    decision <= 1'b0;
    window <= 1'b0;
    first <= 1'b0;
    last <= 1'b0;
    if (rst) begin
      running <= 1'b0;
      left <= 0;
      to_window <= 0;
      of_window <= 0;
    end else if (slot && active) begin
      decision <= 1'b1;
      window <= reached && more;
      first <= !running;
      last <= last_now;
      running <= !last_now;
      left <= running ? left - 1'b1 : slots_per_line;
      if (!running) to_window <= first_slot;
      else if (to_window != 0) to_window <= to_window - 1'b1;
      if (!running) of_window <= window_slots;
      else if (entered && of_window != 0) of_window <= of_window - 1'b1;
    end
  end

`ifdef FORMAL
  reg [W:0] decisions;  // of this line, the one shown now included
  reg [W-1:0] line_slots, line_first, line_window;
  reg valid = 1'b0;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    if (rst) decisions <= 0;
    else if (slot && active) decisions <= running ? decisions + 1'b1 : {{W{1'b0}}, 1'b1};
    if (slot && !running) {line_slots, line_first, line_window} <= {slots_per_line, first_slot, window_slots};
  end
  wire [W:0] index = decisions - 1'b1;
  wire [W:0] past = index - {1'b0, line_first};  // slots since the window began, where it has
  wire is_past = index >= {1'b0, line_first};
  always @(*) if (valid) begin
    if (running) begin
      assert (decisions != 0 && decisions < {1'b0, line_slots});
      assert ({1'b0, left} + index == {1'b0, line_slots});
      assert ({1'b0, to_window} == (is_past ? 0 : {1'b0, line_first} - index));
      assert ({1'b0, of_window} == (!is_past ? {1'b0, line_window} : past < {1'b0, line_window} ? {1'b0, line_window} - past : 0));
    end
    if (last) assert (decisions == {1'b0, line_slots} && !running);  // exactly np decisions
    if (decision && !last) assert (running);
    if (first) assert (decision && decisions == 1);
    if (window || first || last) assert (decision);
    if (decision) assert (slot_out);
    if (decision) assert (window == (is_past && past < {1'b0, line_window}));
  end
`endif
endmodule
`default_nettype wire
