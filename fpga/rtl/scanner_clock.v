// Scanner clock: a strobe every slots_per_microvector-th slot of a line, in phase with the line's first slot.
//
// A setting of 0 acts as 1. Latency: one clock after the sequencer's outputs. Reset: idle.
`default_nettype none
module scanner_clock #(
    parameter W = 16
) (
    input wire clk,
    input wire rst,
    input wire decision,
    input wire first,
    input wire [W-1:0] slots_per_microvector,
    output reg scan
);
  reg [W-1:0] phase;
  wire [W-1:0] now = first ? {W{1'b0}} : phase;
  wire wrap = {1'b0, now} + 1'b1 >= {1'b0, slots_per_microvector};

  always @(posedge clk) begin
    scan <= !rst && decision && now == 0;
    if (rst) phase <= 0;
    else if (decision) phase <= wrap ? {W{1'b0}} : now + 1'b1;
  end

`ifdef FORMAL
  reg valid = 1'b0;
  reg was_first, was_decision;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    was_first <= first && decision && !rst;
    was_decision <= decision && !rst;
  end
  always @(*) if (valid) begin
    if (was_first) assert (scan);  // phase-locked to the line
    if (scan) assert (was_decision);
  end
`endif
endmodule
`default_nettype wire
