// Index reference: measures the axis against the plan once per revolution and lets the lines follow it.
//
// The first index after `enable` rises is the reference. From then on `ahead` counts down the plan's clocks to the next
// one, those by which lines were made longer or shorter left out; at the index its negative is the error: how many
// clocks the axis is late. An error within `window` becomes `pending`; at each line_end up to `limit` clocks of it go to
// the slot divider (adjust, amount), so that the lines are stretched or shortened until they meet the axis again.
// An index that comes earlier than the window is not one and is dropped; one that is missing by more than the window is
// taken as if it had come on plan, without a correction. Both set `lost`, sticky until clear.
//
// limit is to stand while enable is high: on a change `ahead` would go another way than `pending` for a clock.
// index is a pin, two flip-flops bring it into this clock; its rising edge counts.
// Latency: error INDEX_LATENCY after the pin's edge; adjust ADJUST_LATENCY after line_end at the earliest, later where an
// index comes at that time. Reset and enable low: no reference, nothing pending.
`default_nettype none
module index_reference #(
    parameter BITS = 48,
    parameter W = 16
) (
    input wire clk,
    input wire rst,
    input wire clear,
    input wire enable,
    input wire index,
    input wire line_end,
    input wire [BITS-1:0] revolution,
    input wire [W-1:0] window,
    input wire [7:0] limit,
    output reg adjust,
    output reg [8:0] amount,
    output reg [W+1:0] error,
    output reg referenced,
    output reg lost
);
  reg [2:0] pin;
  wire edge_seen = pin[1] && !pin[2];
  reg signed [BITS-1:0] ahead;
  reg [BITS-1:0] revolution_less;
  reg missing;
  reg signed [W+1:0] pending;
  reg signed [8:0] part;       // of pending, for the next line
  reg signed [9:0] part_less;  // that less the clock it is taken in
  reg signed [8:0] limit_less;
  reg wanted, settled;

  // Where `ahead` was a clock ago: within W bits of 0, above or below, and there within the window.
  reg sign, at_plus, at_minus, in_window, in_window_less;
  wire near_above = at_plus && in_window;
  wire near_below = at_minus && in_window_less;
  wire near = near_above || near_below;
  wire early = !sign && !near_above;
  wire late = sign && !near_below;
  wire [W:0] less_sum = {1'b0, ahead[W-1:0]} + {1'b0, window};  // its carry: ahead, W bits and a sign, is not below -window
  wire signed [W+1:0] most = $signed({{(W - 6) {1'b0}}, limit});
  wire above = pending > most;
  wire below = pending < -most;
  // A turn is decided one clock before it is taken, and not again before `near` and `late` know of it.
  reg take, turn, turned;
  wire free = !turn && !turned;
  wire serve = wanted && settled && !turn;

  always @(posedge clk) begin
    pin <= rst ? 3'b111 : {pin[1:0], index};
    revolution_less <= revolution - 1'b1;
    sign <= ahead[BITS-1];
    at_plus <= ahead[BITS-1:W] == 0;
    at_minus <= &ahead[BITS-1:W];
    in_window <= $unsigned(ahead[W-1:0]) <= window;
    in_window_less <= less_sum[W];
    limit_less <= {1'b0, limit} - 1'b1;
    part <= above ? {1'b0, limit} : below ? -{1'b0, limit} : pending[8:0];
    part_less <= above ? {limit_less[8], limit_less} : below ? {2'b11, ~limit} : {pending[8], pending[8:0]} - 1'b1;
    adjust <= 1'b0;
    if (rst || !enable) begin
      referenced <= 1'b0;
      ahead <= 0;
      missing <= 1'b0;
      take <= 1'b0;
      turn <= 1'b0;
      turned <= 1'b0;
      pending <= 0;
      wanted <= 1'b0;
      settled <= 1'b0;
      if (rst) error <= 0;
      if (rst) amount <= 0;
    end else begin
      missing <= referenced && late && free && !missing;
      take <= referenced && edge_seen && near && free && !missing;
      turn <= referenced ? free && (missing || (edge_seen && near)) : edge_seen && free;
      turned <= turn;
      ahead <= ahead + (turn ? $signed(revolution_less) :
                        serve ? $signed({{(BITS - 10) {part_less[9]}}, part_less}) : {BITS{referenced}});  // -1, or 0
      if (turn) referenced <= 1'b1;
      settled <= !turn && !serve;
      if (take) begin
        pending <= -ahead[W+1:0];
        error <= -ahead[W+1:0];
      end else if (serve) pending <= pending - {{(W - 7) {part[8]}}, part};
      if (serve && part != 0) begin
        adjust <= 1'b1;
        amount <= part;
      end
      if (line_end) wanted <= referenced;
      else if (serve) wanted <= 1'b0;
    end
    if (rst || clear) lost <= 1'b0;
    else if (enable && referenced && ((edge_seen && early) || missing)) lost <= 1'b1;
  end

`ifdef FORMAL
  reg valid = 1'b0;
  reg signed [W+1:0] past_pending;
  reg past_take, past_ready;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    past_pending <= pending;
    past_take <= take;
    past_ready <= enable && referenced && !rst;
  end
  (* anyconst *) reg [7:0] fixed;
  always @(*) assume (limit == fixed);
  // Never more than limit clocks a line, and never past the error.
  always @(*) if (valid) begin
    if (adjust) assert ($signed(amount) <= $signed({1'b0, fixed}) && $signed(amount) >= -$signed({1'b0, fixed}));
    if (settled) assert (part <= $signed({1'b0, fixed}) && part >= -$signed({1'b0, fixed}));
    if (adjust) assert (past_ready);
    if (adjust && !past_take) assert ((past_pending > 0) == ($signed(amount) > 0));
    if (adjust && $signed(amount) > 0) assert (pending >= 0 || past_take);
    if (adjust && $signed(amount) < 0) assert (pending <= 0 || past_take);
    if (!referenced) assert (pending == 0);
    if (settled) assert (pending >= 0 ? part >= 0 && {{(W - 7) {part[8]}}, part} <= pending
                                      : part <= 0 && $signed({{(W - 7) {part[8]}}, part}) >= pending);
  end
`endif
endmodule
`default_nettype wire
