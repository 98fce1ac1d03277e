// Slot divider: a strobe at the first seed clock of every pulse slot, every seeds_per_slot-th clock (k).
//
// run low stops it; the first slot begins on the clock that finds run high. A seeds_per_slot of 0 acts as 1. adjust makes
// the slot that runs longer by `amount` (two's complement: or shorter; a slot that is over by then ends at once).
// Latency: SLOT_LATENCY; `slot` is a flip-flop, high in the clock after the one it marks. Reset: idle.
`default_nettype none
module slot_divider #(
    parameter W = 16
) (
    input wire clk,
    input wire rst,
    input wire run,
    input wire [W-1:0] seeds_per_slot,
    input wire adjust,
    input wire [8:0] amount,
    output reg slot
);
  // phase + 1 of the clock that comes, and how many clocks the slot lasts; one bit more than k for the adjustment.
  reg [W:0] count, length;
  reg begins;

  always @(posedge clk) begin
    if (rst || !run) begin
      slot <= 1'b0;
      count <= 1;
      length <= {1'b0, seeds_per_slot};
      begins <= 1'b1;
    end else begin
      slot <= begins;
      begins <= count >= length;
      count <= count >= length ? {{W{1'b0}}, 1'b1} : count + 1'b1;
      if (count >= length) length <= {1'b0, seeds_per_slot};
      else if (adjust) length <= length + {{(W - 8) {amount[8]}}, amount};
    end
  end

`ifdef FORMAL
  // With a constant k: a slot lasts k clocks, and what it was adjusted by, if that came in time.
  (* anyconst *) reg [W-1:0] fixed;
  reg [W+1:0] since, want;  // of the slot that runs: clocks so far, and how many it is to last
  wire [W+1:0] change = {{(W - 7) {amount[8]}}, amount};
  wire changes = adjust && count < length;
  reg seen = 1'b0;
  initial assume (rst);
  always @(*) begin
    assume (seeds_per_slot == fixed && fixed != 0 && fixed < 1 << (W - 1));
    if (changes && begins) assume (fixed + change >= 2 && fixed + change < 1 << W);
    if (changes && !begins) assume (want + change >= since + 2 && want + change < 1 << W);
  end
  always @(posedge clk) begin
    if (rst || !run) seen <= 1'b0;
    else if (begins) begin
      seen  <= 1'b1;
      since <= 1;
      want  <= fixed + (changes ? change : 0);
    end else begin
      since <= since + 1'b1;
      if (changes) want <= want + change;
    end
  end
  always @(*) if (seen) begin
    assert (slot == (since == 1));
    assert (begins == (since == want) && since <= want);
    assert (begins ? count == 1 && length == fixed : count == since + 1 && length == want);
  end
`endif
endmodule
`default_nettype wire
