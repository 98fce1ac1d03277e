// Direction delay: lets the slots of backward lines come `delay` clocks later, so that the pixels of both directions meet.
//
// Sits between line sequencer and gate; the scanner clock is not delayed. `reverse` is looked at with a line's first
// slot. Whole slots of delay are in the line's first slot already, so delay is less than a slot lasts: never more than
// one slot waits here. Slots outside lines are not delayed.
// Latency: DELAY_LATENCY, for backward lines 1 + delay. Reset: nothing waits.
`default_nettype none
module direction_delay #(
    parameter W = 16
) (
    input wire clk,
    input wire rst,
    input wire [W-1:0] delay,
    input wire reverse,
    input wire slot_in,
    input wire decision_in,
    input wire window_in,
    input wire first_in,
    input wire last_in,
    output reg slot,
    output reg decision,
    output reg window,
    output reg first,
    output reg last
);
  reg line_reverse;
  wire now_reverse = first_in ? reverse : line_reverse;
  wire wait_in = slot_in && decision_in && now_reverse && delay != 0;
  reg [W-1:0] left;  // clocks until the waiting slot goes on
  reg waiting, wait_window, wait_first, wait_last;

  always @(posedge clk) begin
    slot <= 1'b0;
    decision <= 1'b0;
    window <= 1'b0;
    first <= 1'b0;
    last <= 1'b0;
    if (rst) begin
      line_reverse <= 1'b0;
      waiting <= 1'b0;
      left <= 0;
    end else begin
      if (slot_in && decision_in) line_reverse <= now_reverse;
      if (slot_in && !wait_in) begin
        slot <= 1'b1;
        decision <= decision_in;
        window <= window_in;
        first <= first_in;
        last <= last_in;
      end else if (waiting && left == 1) begin
        slot <= 1'b1;
        decision <= 1'b1;
        window <= wait_window;
        first <= wait_first;
        last <= wait_last;
      end
      if (wait_in) begin
        waiting <= 1'b1;
        left <= delay;
      end else begin
        if (left == 1) waiting <= 1'b0;
        if (waiting) left <= left - 1'b1;
      end
    end
    if (wait_in) begin
      wait_window <= window_in;
      wait_first <= first_in;
      wait_last <= last_in;
    end
  end

`ifdef FORMAL
  // Slots that are further apart than the delay all come out, in order, each once and unchanged.
  (* anyconst *) reg [W-1:0] fixed;
  reg [W:0] since = 0;  // clocks since the last slot came in
  reg [3:0] sent = 0, seen = 0;
  reg valid = 1'b0;
  reg [2:0] expected;  // of the slot that came in last
  reg is_line;
  initial assume (rst);
  always @(*) begin
    assume (delay == fixed);
    if (slot_in && valid) assume (since > {1'b0, fixed});
    if (!slot_in) assume (!decision_in);
    if (!decision_in) assume (!window_in && !first_in && !last_in);
  end
  always @(posedge clk) begin
    valid <= 1'b1;
    if (rst) begin
      since <= {(W + 1) {1'b1}};
      sent <= 0;
      seen <= 0;
    end else begin
      if (slot_in) since <= 1;
      else if (since != {(W + 1) {1'b1}}) since <= since + 1'b1;
      if (slot_in) sent <= sent + 1'b1;
      if (slot_in) {is_line, expected} <= {decision_in, window_in, first_in, last_in};
      if (slot) seen <= seen + 1'b1;
    end
  end
  wire [3:0] out = seen + {3'd0, slot};
  always @(*) if (valid) begin
    assert (out + {3'd0, waiting} == sent);
    if (slot) assert (decision == is_line && {window, first, last} == expected);
    if (!slot) assert (!decision && !window && !first && !last);
    if (waiting) assert (left != 0 && is_line && since + left == fixed + 1 && expected == {wait_window, wait_first, wait_last});
  end
`endif
endmodule
`default_nettype wire
