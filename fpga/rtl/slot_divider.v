// Slot divider: a strobe at the first tick of every pulse slot, every ticks_per_slot-th clock (j * k).
//
// run low stops it; the first slot begins on the clock that finds run high. A ticks_per_slot of 0 acts as 1.
// Latency: `slot` is a flip-flop, high in the clock after the tick it marks. Reset: idle.
`default_nettype none
module slot_divider #(
    parameter W = 16
) (
    input wire clk,
    input wire rst,
    input wire run,
    input wire [W-1:0] ticks_per_slot,
    output reg slot
);
  reg [W-1:0] phase;
  wire wrap = {1'b0, phase} + 1'b1 >= {1'b0, ticks_per_slot};

  always @(posedge clk) begin
    if (rst || !run) begin
      phase <= 0;
      slot <= 1'b0;
    end else begin
      slot <= phase == 0;
      phase <= wrap ? {W{1'b0}} : phase + 1'b1;
    end
  end

`ifdef FORMAL
  // With a constant setting: from one slot to the next exactly ticks_per_slot clocks.
  (* anyconst *) reg [W-1:0] fixed;
  reg [W:0] since;
  reg seen = 1'b0;
  initial assume (rst);
  always @(*) assume (ticks_per_slot == fixed && fixed != 0);
  always @(posedge clk) begin
    if (rst || !run) seen <= 1'b0;
    else if (phase == 0) begin
      seen  <= 1'b1;
      since <= 1;
    end else since <= since + 1'b1;
  end
  always @(*) if (seen) begin
    assert (slot == (since == 1));
    assert (phase == (since == {1'b0, fixed} ? 0 : since[W-1:0]));
    assert (since <= {1'b0, fixed} && since != 0);
  end
`endif
endmodule
`default_nettype wire
