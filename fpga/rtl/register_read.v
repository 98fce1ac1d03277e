// Register read: what the host finds at an address, in two steps so that the multiplexer is no long path.
//
// Latency: two clocks from address to read_data (READ_LATENCY); the value is that of the clock after the address.
// Reset: 0.
`default_nettype none
module register_read #(
    parameter FIFO_BITS = 12
) (
    input wire clk,
    input wire rst,
    input wire [7:0] address,
    input wire [6:0] control,
    input wire [15:0] status,
    input wire [FIFO_BITS+1:0] level,
    input wire [5:0] faults,
    input wire [17:0] index_error,
    input wire [31:0] increment,
    input wire [31:0] prescaler,
    input wire [33:0] fraction_num,
    input wire [33:0] fraction_den,
    input wire [31:0] increment_1,
    input wire [31:0] prescaler_1,
    input wire [33:0] fraction_num_1,
    input wire [33:0] fraction_den_1,
    input wire [15:0] seeds_per_slot,
    input wire [15:0] slots_per_line,
    input wire [15:0] window_slots,
    input wire [15:0] slots_per_microvector,
    input wire [31:0] lines_per_revolution,
    input wire [31:0] position_revolution,
    input wire [31:0] position_line,
    input wire [31:0] silence_limit,
    input wire [31:0] first_tick,
    input wire [15:0] reverse_delay,
    input wire [15:0] low_level,
    input wire [7:0] correction_limit,
    input wire [15:0] index_window,
    input wire [47:0] revolution_seeds,
    input wire [31:0] schedule_increment,
    input wire [31:0] schedule_seeds,
    output reg [31:0] read_data
);
  /* verilator lint_off UNUSEDPARAM */
  `include "registers.vh"
  /* verilator lint_on UNUSEDPARAM */

  reg of_rom;
  reg [31:0] of_board, of_axes, of_lines, of_machine;
  wire [31:0] descriptor;
  descriptor_rom rom (.clk(clk), .number(address[5:0]), .word(descriptor));

  always @(posedge clk) begin
    of_rom <= address[7:6] == 2'b10;
    case (address)
      ADDRESS_MAGIC: of_board <= RESET_MAGIC;
      ADDRESS_VERSION: of_board <= RESET_VERSION;
      ADDRESS_COUNTER_BITS: of_board <= {24'd0, RESET_COUNTER_BITS};
      ADDRESS_FIFO_BITS: of_board <= FIFO_BITS;
      ADDRESS_CLOCK_MULTIPLIER: of_board <= {24'd0, RESET_CLOCK_MULTIPLIER};
      ADDRESS_CONTROL: of_board <= {25'd0, control};
      ADDRESS_STATUS: of_board <= {16'd0, status};
      ADDRESS_FIFO_LEVEL: of_board <= {{(30 - FIFO_BITS) {1'b0}}, level};
      ADDRESS_FAULTS: of_board <= {26'd0, faults};
      ADDRESS_INDEX_ERROR: of_board <= {{14{index_error[17]}}, index_error};
      default: of_board <= 32'd0;
    endcase
    case (address)
      ADDRESS_INCREMENT: of_axes <= increment;
      ADDRESS_PRESCALER: of_axes <= prescaler;
      ADDRESS_FRACTION_NUM: of_axes <= fraction_num[31:0];
      ADDRESS_FRACTION_NUM + 8'd1: of_axes <= {30'd0, fraction_num[33:32]};
      ADDRESS_FRACTION_DEN: of_axes <= fraction_den[31:0];
      ADDRESS_FRACTION_DEN + 8'd1: of_axes <= {30'd0, fraction_den[33:32]};
      ADDRESS_INCREMENT_1: of_axes <= increment_1;
      ADDRESS_PRESCALER_1: of_axes <= prescaler_1;
      ADDRESS_FRACTION_NUM_1: of_axes <= fraction_num_1[31:0];
      ADDRESS_FRACTION_NUM_1 + 8'd1: of_axes <= {30'd0, fraction_num_1[33:32]};
      ADDRESS_FRACTION_DEN_1: of_axes <= fraction_den_1[31:0];
      ADDRESS_FRACTION_DEN_1 + 8'd1: of_axes <= {30'd0, fraction_den_1[33:32]};
      default: of_axes <= 32'd0;
    endcase
    case (address)
      ADDRESS_SEEDS_PER_SLOT: of_lines <= {16'd0, seeds_per_slot};
      ADDRESS_SLOTS_PER_LINE: of_lines <= {16'd0, slots_per_line};
      ADDRESS_WINDOW_SLOTS: of_lines <= {16'd0, window_slots};
      ADDRESS_SLOTS_PER_MICROVECTOR: of_lines <= {16'd0, slots_per_microvector};
      ADDRESS_LINES_PER_REVOLUTION: of_lines <= lines_per_revolution;
      ADDRESS_POSITION_REVOLUTION: of_lines <= position_revolution;
      ADDRESS_POSITION_LINE: of_lines <= position_line;
      default: of_lines <= 32'd0;
    endcase
    case (address)
      ADDRESS_SILENCE_LIMIT: of_machine <= silence_limit;
      ADDRESS_FIRST_TICK: of_machine <= first_tick;
      ADDRESS_REVERSE_DELAY: of_machine <= {16'd0, reverse_delay};
      ADDRESS_LOW_LEVEL: of_machine <= {16'd0, low_level};
      ADDRESS_CORRECTION_LIMIT: of_machine <= {24'd0, correction_limit};
      ADDRESS_INDEX_WINDOW: of_machine <= {16'd0, index_window};
      ADDRESS_REVOLUTION_SEEDS: of_machine <= revolution_seeds[31:0];
      ADDRESS_REVOLUTION_SEEDS + 8'd1: of_machine <= {16'd0, revolution_seeds[47:32]};
      ADDRESS_SCHEDULE_INCREMENT: of_machine <= schedule_increment;
      ADDRESS_SCHEDULE_SEEDS: of_machine <= schedule_seeds;
      default: of_machine <= 32'd0;
    endcase
    read_data <= rst ? 32'd0 : of_rom ? descriptor : of_board | of_axes | of_lines | of_machine;
  end
endmodule
`default_nettype wire
