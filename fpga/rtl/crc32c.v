// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78), one byte a clock.
//
// start begins a new message (a byte on the same clock is its first); crc is the checksum of the bytes so far.
// Latency: CRC_LATENCY. Reset: as after start.
`default_nettype none
module crc32c (
    input wire clk,
    input wire rst,
    input wire start,
    input wire valid,
    input wire [7:0] data,
    output wire [31:0] crc
);
  reg [31:0] state;
  assign crc = ~state;

  function [31:0] after_byte(input [31:0] state_in, input [7:0] value);
    integer bit_number;
    begin
      after_byte = state_in ^ {24'd0, value};
      for (bit_number = 0; bit_number < 8; bit_number = bit_number + 1)
        after_byte = (after_byte >> 1) ^ (after_byte[0] ? 32'h82F63B78 : 32'd0);
    end
  endfunction

  wire [31:0] from = start ? 32'hFFFFFFFF : state;
  always @(posedge clk) begin
    if (rst) state <= 32'hFFFFFFFF;
    else state <= valid ? after_byte(from, data) : from;
  end
endmodule
`default_nettype wire
