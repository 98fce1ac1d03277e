// Register read: what the host finds at an address. Registers that it writes are kept here once more, in a block RAM, as
// they were accepted (a low word as soon as it was written); until their first write they read as after reset.
//
// Latency: READ_LATENCY from address to read_data; the value is that of the clock after the address.
// Reset: 0, nothing written.
`default_nettype none
module register_read #(
    parameter FIFO_BITS = 12
) (
    input wire clk,
    input wire rst,
    input wire [7:0] address,
    input wire [15:0] status,
    input wire [FIFO_BITS+1:0] level,
    input wire [5:0] faults,
    input wire [17:0] index_error,
    input wire [31:0] executed_lines,
    input wire [31:0] closed_slot,
    input wire store,
    input wire [7:0] store_address,
    input wire [31:0] store_data,
    output reg [31:0] read_data
);
  /* verilator lint_off UNUSEDPARAM */
  `include "registers.vh"
  /* verilator lint_on UNUSEDPARAM */

  reg of_rom, of_memory;
  reg [31:0] of_board, stored, initial_word;
  wire [31:0] descriptor;
  descriptor_rom rom (.clk(clk), .number(address[5:0]), .word(descriptor));

  reg [31:0] memory[0:255];
  reg [63:0] written;  // since the reset; no two registers that are stored have the lower six bits in common
  always @(posedge clk) begin
    if (store) memory[store_address] <= store_data;
    stored <= memory[address];
  end
  always @(posedge clk) begin
    if (rst) written <= 64'd0;
    else if (store) written[store_address[5:0]] <= 1'b1;
    of_rom <= address[7:6] == 2'b10;
    of_memory <= reads_back(address) && written[address[5:0]];
    initial_word <= reset_word(address);
    case (address)
      ADDRESS_MAGIC: of_board <= RESET_MAGIC;
      ADDRESS_VERSION: of_board <= RESET_VERSION;
      ADDRESS_COUNTER_BITS: of_board <= {24'd0, RESET_COUNTER_BITS};
      ADDRESS_FIFO_BITS: of_board <= FIFO_BITS;
      ADDRESS_CLOCK_MULTIPLIER: of_board <= {24'd0, RESET_CLOCK_MULTIPLIER};
      ADDRESS_STATUS: of_board <= {16'd0, status};
      ADDRESS_FIFO_LEVEL: of_board <= {{(30 - FIFO_BITS) {1'b0}}, level};
      ADDRESS_FAULTS: of_board <= {26'd0, faults};
      ADDRESS_INDEX_ERROR: of_board <= {{14{index_error[17]}}, index_error};
      ADDRESS_EXECUTED_LINES: of_board <= executed_lines;
      ADDRESS_CLOSED_SLOT: of_board <= closed_slot;
      default: of_board <= 32'd0;
    endcase
    read_data <= rst ? 32'd0 : of_rom ? descriptor : of_board | (of_memory ? stored : initial_word);
  end
endmodule
`default_nettype wire
