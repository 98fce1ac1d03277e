// Scanner clock: a strobe every slots_per_microvector-th slot of a line, in phase with the line's first slot.
//
// A setting of 0 acts as 1; it is to stand for a clock before a line. Latency: SCAN_LATENCY after the sequencer's outputs. Reset: idle.
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
  // Decisions until the next strobe; the setting less one, that of 0 too.
  reg [W-1:0] left, reload;
  reg due;  // left is 0
  wire strobe = first || due;

  always @(posedge clk) begin
    reload <= slots_per_microvector == 0 ? {W{1'b0}} : slots_per_microvector - 1'b1;
    scan <= !rst && decision && strobe;
    if (rst) begin
      left <= 0;
      due <= 1'b1;
    end else if (decision) begin
      left <= strobe ? reload : left - 1'b1;
      due <= strobe ? reload == 0 : left == 1;
    end
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
