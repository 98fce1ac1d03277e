// Settings: the registers that the host writes (registers.vh), and what of them the board refuses.
//
// A refused write changes nothing and sets `refused`, sticky until clear:
//   - 0 to a register whose range begins with 1, or more bits than the register has;
//   - anything from 0x30 to 0x35 and from 0x39 to 0x3f, low_level apart, while slots run;
//   - slots to run while slots_per_line is 0 or smaller than window_slots, reverse_delay is not less than seeds_per_slot,
//     or a correction_limit that is not 0 leaves less than 8 clocks of a slot beside the delay; or in the four clocks
//     after one of these was written.
// `command` is high for one clock. Values of two words are taken with their high word. `store` goes with every accepted
// write of a register that can be read back: what was written where.
// Latency: SETTINGS_LATENCY: the word is taken aside and looked at, then accepted. Reset: as the map says.
`default_nettype none
module settings (
    input wire clk,
    input wire rst,
    input wire clear,
    input wire write,
    input wire [7:0] address,
    input wire [31:0] write_data,
    output reg [8:0] control,
    output reg [9:0] command,
    output reg [31:0] increment,
    output reg [31:0] prescaler,
    output reg [33:0] fraction_num,
    output reg [33:0] fraction_den,
    output reg [31:0] increment_1,
    output reg [31:0] prescaler_1,
    output reg [33:0] fraction_num_1,
    output reg [33:0] fraction_den_1,
    output reg [15:0] seeds_per_slot,
    output reg [23:0] slots_per_line,
    output reg [23:0] window_slots,
    output reg [23:0] slots_per_microvector,
    output reg [31:0] lines_per_revolution,
    output reg [31:0] position_revolution,
    output reg [31:0] position_line,
    output reg [31:0] silence_limit,
    output reg [31:0] first_tick,
    output reg [15:0] reverse_delay,
    output reg [15:0] low_level,
    output reg [7:0] correction_limit,
    output reg [15:0] index_window,
    output reg [47:0] revolution_seeds,
    output reg [31:0] schedule_increment,
    output reg [31:0] schedule_seeds,
    output wire store,
    output reg [7:0] store_address,
    output reg [31:0] store_data,
    output reg refused
);
  /* verilator lint_off UNUSEDPARAM */
  `include "registers.vh"
  /* verilator lint_on UNUSEDPARAM */

  reg [31:0] low_word;  // waits for its high one
  reg [2:0] young;      // clocks until the settings have been checked
  reg [16:0] least_slot;
  reg fits;

  // The word of the clock before: whether there is one, whether it is wrong by itself, and what it is.
  reg asked, bad_word, line_setting, starts, stored;
  wire line_address = address[7:4] == 4'h3 && address[3:1] != 3'b011 && address[3:0] != 4'h8 && address[3:0] != 4'hb;
  wire bad_now = (write_data == 0 && refuses_zero(address)) || (write_data & unused_bits(address)) != 0;
  always @(posedge clk) begin
    asked <= write && !bad_now && !rst;
    bad_word <= write && bad_now && !rst;
    store_address <= address;
    store_data <= write_data;
    line_setting <= line_address;
    starts <= address == ADDRESS_CONTROL && write_data[0];
    stored <= reads_back(address);
  end
  wire bad_line = line_setting && control[0];
  wire bad_start = starts && !control[0] && (!fits || young != 0);
  wire accept = asked && !bad_line;  // of control: && !bad_start
  assign store = accept && !bad_start && stored;

  always @(posedge clk) begin
    least_slot <= {1'b0, reverse_delay} + (correction_limit == 0 ? 17'd1 : {9'd0, correction_limit} + 17'd8);
    fits <= slots_per_line != 0 && window_slots <= slots_per_line && least_slot <= {1'b0, seeds_per_slot};
    command <= 10'd0;
    if (rst) begin
      control <= RESET_CONTROL;
      increment <= RESET_INCREMENT;
      prescaler <= RESET_PRESCALER;
      fraction_num <= RESET_FRACTION_NUM;
      fraction_den <= RESET_FRACTION_DEN;
      increment_1 <= RESET_INCREMENT_1;
      prescaler_1 <= RESET_PRESCALER_1;
      fraction_num_1 <= RESET_FRACTION_NUM_1;
      fraction_den_1 <= RESET_FRACTION_DEN_1;
      low_word <= 0;
      seeds_per_slot <= RESET_SEEDS_PER_SLOT;
      slots_per_line <= RESET_SLOTS_PER_LINE;
      window_slots <= RESET_WINDOW_SLOTS;
      slots_per_microvector <= RESET_SLOTS_PER_MICROVECTOR;
      lines_per_revolution <= RESET_LINES_PER_REVOLUTION;
      position_revolution <= RESET_POSITION_REVOLUTION;
      position_line <= RESET_POSITION_LINE;
      silence_limit <= RESET_SILENCE_LIMIT;
      first_tick <= RESET_FIRST_TICK;
      reverse_delay <= RESET_REVERSE_DELAY;
      low_level <= RESET_LOW_LEVEL;
      correction_limit <= RESET_CORRECTION_LIMIT;
      index_window <= RESET_INDEX_WINDOW;
      revolution_seeds <= RESET_REVOLUTION_SEEDS;
      schedule_increment <= RESET_SCHEDULE_INCREMENT;
      schedule_seeds <= RESET_SCHEDULE_SEEDS;
      refused <= 1'b0;
      young <= 3'd4;
    end else begin
      if (bad_word || (asked && (bad_line || bad_start))) refused <= 1'b1;
      else if (clear) refused <= 1'b0;
      if (accept && line_setting) young <= 3'd4;
      else if (young != 0) young <= young - 3'd1;
      if (accept) begin
        case (store_address)
          ADDRESS_CONTROL: if (!bad_start) control <= store_data[8:0];
          ADDRESS_COMMAND: command <= store_data[9:0];
          ADDRESS_INCREMENT: increment <= store_data;
          ADDRESS_PRESCALER: prescaler <= store_data;
          ADDRESS_FRACTION_NUM + 8'd1: fraction_num <= {store_data[1:0], low_word};
          ADDRESS_FRACTION_DEN + 8'd1: fraction_den <= {store_data[1:0], low_word};
          ADDRESS_INCREMENT_1: increment_1 <= store_data;
          ADDRESS_PRESCALER_1: prescaler_1 <= store_data;
          ADDRESS_FRACTION_NUM_1 + 8'd1: fraction_num_1 <= {store_data[1:0], low_word};
          ADDRESS_FRACTION_DEN_1 + 8'd1: fraction_den_1 <= {store_data[1:0], low_word};
          ADDRESS_SEEDS_PER_SLOT: seeds_per_slot <= store_data[15:0];
          ADDRESS_SLOTS_PER_LINE: slots_per_line <= store_data[23:0];
          ADDRESS_WINDOW_SLOTS: window_slots <= store_data[23:0];
          ADDRESS_SLOTS_PER_MICROVECTOR: slots_per_microvector <= store_data[23:0];
          ADDRESS_LINES_PER_REVOLUTION: lines_per_revolution <= store_data;
          ADDRESS_POSITION_REVOLUTION: position_revolution <= store_data;
          ADDRESS_POSITION_LINE: position_line <= store_data;
          ADDRESS_SILENCE_LIMIT: silence_limit <= store_data;
          ADDRESS_FIRST_TICK: first_tick <= store_data;
          ADDRESS_REVERSE_DELAY: reverse_delay <= store_data[15:0];
          ADDRESS_LOW_LEVEL: low_level <= store_data[15:0];
          ADDRESS_CORRECTION_LIMIT: correction_limit <= store_data[7:0];
          ADDRESS_INDEX_WINDOW: index_window <= store_data[15:0];
          ADDRESS_REVOLUTION_SEEDS + 8'd1: revolution_seeds <= {store_data[15:0], low_word};
          ADDRESS_SCHEDULE_INCREMENT: schedule_increment <= store_data;
          ADDRESS_SCHEDULE_SEEDS: schedule_seeds <= store_data;
          default: ;
        endcase
        case (store_address)
          ADDRESS_FRACTION_NUM, ADDRESS_FRACTION_DEN, ADDRESS_FRACTION_NUM_1, ADDRESS_FRACTION_DEN_1,
          ADDRESS_REVOLUTION_SEEDS: low_word <= store_data;
          default: ;
        endcase
      end
    end
  end

`ifdef FORMAL
  reg valid = 1'b0;
  reg [117:0] past_line;
  reg past_run, past_fits;
  wire [117:0] now_line = {seeds_per_slot, slots_per_line, window_slots, reverse_delay, correction_limit, index_window,
                           slots_per_microvector[13:0]};
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    past_line <= now_line;
    past_run <= control[0] && !rst;
    past_fits <= fits && young == 0;
  end
  always @(*) if (valid) begin
      if (past_run && control[0]) assert (now_line == past_line);
    if (control[0] && !past_run) assert (past_fits);  // they are checked before
    assert (young <= 4);
    assert (slots_per_microvector != 0 && lines_per_revolution != 0 && silence_limit != 0 && schedule_seeds != 0);
  end
`endif
endmodule
`default_nettype wire
