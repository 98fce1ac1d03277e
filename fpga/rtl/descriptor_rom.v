// Descriptor ROM: what the board is made of, one word a block (descriptors.vh, made from fpga/regs/blocks.txt), 0 elsewhere.
//
// Latency: ROM_LATENCY. Reset: none needed.
`default_nettype none
module descriptor_rom (
    input wire clk,
    input wire [5:0] number,
    output reg [31:0] word
);
  always @(posedge clk) begin
    case (number)
      `include "descriptors.vh"
      default: word <= 32'd0;
    endcase
  end
endmodule
`default_nettype wire
