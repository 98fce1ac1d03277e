// Made by fpga/regs/generate.py from registers.txt; change that file.
localparam [7:0] ADDRESS_MAGIC = 8'h00;
localparam [31:0] RESET_MAGIC = 32'h47524156;
localparam [7:0] ADDRESS_VERSION = 8'h01;
localparam [31:0] RESET_VERSION = 32'h4;
localparam [7:0] ADDRESS_COUNTER_BITS = 8'h02;
localparam [7:0] RESET_COUNTER_BITS = 8'h20;
localparam [7:0] ADDRESS_FIFO_BITS = 8'h03;
localparam [7:0] RESET_FIFO_BITS = 8'hc;
localparam [7:0] ADDRESS_CLOCK_MULTIPLIER = 8'h04;
localparam [7:0] RESET_CLOCK_MULTIPLIER = 8'h2;
localparam [7:0] ADDRESS_CONTROL = 8'h10;
localparam [8:0] RESET_CONTROL = 9'h0;
localparam [7:0] ADDRESS_COMMAND = 8'h11;
localparam [9:0] RESET_COMMAND = 10'h0;
localparam [7:0] ADDRESS_STATUS = 8'h12;
localparam [15:0] RESET_STATUS = 16'h0;
localparam [7:0] ADDRESS_FIFO_LEVEL = 8'h13;
localparam [15:0] RESET_FIFO_LEVEL = 16'h0;
localparam [7:0] ADDRESS_FAULTS = 8'h14;
localparam [5:0] RESET_FAULTS = 6'h0;
localparam [7:0] ADDRESS_INDEX_ERROR = 8'h15;
localparam [31:0] RESET_INDEX_ERROR = 32'h0;
localparam [7:0] ADDRESS_EXECUTED_LINES = 8'h16;
localparam [31:0] RESET_EXECUTED_LINES = 32'h0;
localparam [7:0] ADDRESS_CLOSED_SLOT = 8'h17;
localparam [31:0] RESET_CLOSED_SLOT = 32'h0;
localparam [7:0] ADDRESS_INCREMENT = 8'h20;
localparam [31:0] RESET_INCREMENT = 32'h0;
localparam [7:0] ADDRESS_PRESCALER = 8'h22;
localparam [31:0] RESET_PRESCALER = 32'h1;
localparam [7:0] ADDRESS_FRACTION_NUM = 8'h24;
localparam [33:0] RESET_FRACTION_NUM = 34'h0;
localparam [7:0] ADDRESS_FRACTION_DEN = 8'h26;
localparam [33:0] RESET_FRACTION_DEN = 34'h1;
localparam [7:0] ADDRESS_INCREMENT_1 = 8'h28;
localparam [31:0] RESET_INCREMENT_1 = 32'h0;
localparam [7:0] ADDRESS_PRESCALER_1 = 8'h2a;
localparam [31:0] RESET_PRESCALER_1 = 32'h1;
localparam [7:0] ADDRESS_FRACTION_NUM_1 = 8'h2c;
localparam [33:0] RESET_FRACTION_NUM_1 = 34'h0;
localparam [7:0] ADDRESS_FRACTION_DEN_1 = 8'h2e;
localparam [33:0] RESET_FRACTION_DEN_1 = 34'h1;
localparam [7:0] ADDRESS_SEEDS_PER_SLOT = 8'h30;
localparam [15:0] RESET_SEEDS_PER_SLOT = 16'h1;
localparam [7:0] ADDRESS_SLOTS_PER_LINE = 8'h31;
localparam [23:0] RESET_SLOTS_PER_LINE = 24'h0;
localparam [7:0] ADDRESS_WINDOW_SLOTS = 8'h32;
localparam [23:0] RESET_WINDOW_SLOTS = 24'h0;
localparam [7:0] ADDRESS_SLOTS_PER_MICROVECTOR = 8'h33;
localparam [23:0] RESET_SLOTS_PER_MICROVECTOR = 24'h1;
localparam [7:0] ADDRESS_LINES_PER_REVOLUTION = 8'h34;
localparam [31:0] RESET_LINES_PER_REVOLUTION = 32'h1;
localparam [7:0] ADDRESS_POSITION_REVOLUTION = 8'h36;
localparam [31:0] RESET_POSITION_REVOLUTION = 32'h0;
localparam [7:0] ADDRESS_POSITION_LINE = 8'h37;
localparam [31:0] RESET_POSITION_LINE = 32'h0;
localparam [7:0] ADDRESS_SILENCE_LIMIT = 8'h38;
localparam [31:0] RESET_SILENCE_LIMIT = 32'h7d1f40;
localparam [7:0] ADDRESS_FIRST_TICK = 8'h39;
localparam [31:0] RESET_FIRST_TICK = 32'h0;
localparam [7:0] ADDRESS_REVERSE_DELAY = 8'h3a;
localparam [15:0] RESET_REVERSE_DELAY = 16'h0;
localparam [7:0] ADDRESS_LOW_LEVEL = 8'h3b;
localparam [15:0] RESET_LOW_LEVEL = 16'h0;
localparam [7:0] ADDRESS_CORRECTION_LIMIT = 8'h3c;
localparam [7:0] RESET_CORRECTION_LIMIT = 8'h0;
localparam [7:0] ADDRESS_INDEX_WINDOW = 8'h3d;
localparam [15:0] RESET_INDEX_WINDOW = 16'h0;
localparam [7:0] ADDRESS_REVOLUTION_SEEDS = 8'h3e;
localparam [47:0] RESET_REVOLUTION_SEEDS = 48'h0;
localparam [7:0] ADDRESS_SCHEDULE_INCREMENT = 8'h40;
localparam [31:0] RESET_SCHEDULE_INCREMENT = 32'h0;
localparam [7:0] ADDRESS_SCHEDULE_SEEDS = 8'h41;
localparam [31:0] RESET_SCHEDULE_SEEDS = 32'h1;
localparam [7:0] ADDRESS_DESCRIPTOR = 8'h80;
localparam [31:0] RESET_DESCRIPTOR = 32'h0;
// The bits of a word that no register has. (No case: it would become a memory.)
function [31:0] unused_bits(input [7:0] at);
  unused_bits = 32'd0
      | {32{at == ADDRESS_FRACTION_NUM + 8'd1 ||
             at == ADDRESS_FRACTION_DEN + 8'd1 ||
             at == ADDRESS_FRACTION_NUM_1 + 8'd1 ||
             at == ADDRESS_FRACTION_DEN_1 + 8'd1}} & 32'hfffffffc
      | {32{at == ADDRESS_CORRECTION_LIMIT}} & 32'hffffff00
      | {32{at == ADDRESS_CONTROL}} & 32'hfffffe00
      | {32{at == ADDRESS_COMMAND}} & 32'hfffffc00
      | {32{at == ADDRESS_SEEDS_PER_SLOT ||
             at == ADDRESS_REVERSE_DELAY ||
             at == ADDRESS_LOW_LEVEL ||
             at == ADDRESS_INDEX_WINDOW ||
             at == ADDRESS_REVOLUTION_SEEDS + 8'd1}} & 32'hffff0000
      | {32{at == ADDRESS_SLOTS_PER_LINE ||
             at == ADDRESS_WINDOW_SLOTS ||
             at == ADDRESS_SLOTS_PER_MICROVECTOR}} & 32'hff000000;
endfunction
// Of these the register file refuses a 0.
function refuses_zero(input [7:0] at);
  refuses_zero = at == ADDRESS_SEEDS_PER_SLOT ||
      at == ADDRESS_SLOTS_PER_LINE ||
      at == ADDRESS_SLOTS_PER_MICROVECTOR ||
      at == ADDRESS_LINES_PER_REVOLUTION ||
      at == ADDRESS_SILENCE_LIMIT ||
      at == ADDRESS_SCHEDULE_SEEDS;
endfunction
// These are read back as they were written.
function reads_back(input [7:0] at);
  reads_back = at == ADDRESS_CONTROL ||
      at == ADDRESS_INCREMENT ||
      at == ADDRESS_PRESCALER ||
      at == ADDRESS_FRACTION_NUM ||
      at == ADDRESS_FRACTION_NUM + 8'd1 ||
      at == ADDRESS_FRACTION_DEN ||
      at == ADDRESS_FRACTION_DEN + 8'd1 ||
      at == ADDRESS_INCREMENT_1 ||
      at == ADDRESS_PRESCALER_1 ||
      at == ADDRESS_FRACTION_NUM_1 ||
      at == ADDRESS_FRACTION_NUM_1 + 8'd1 ||
      at == ADDRESS_FRACTION_DEN_1 ||
      at == ADDRESS_FRACTION_DEN_1 + 8'd1 ||
      at == ADDRESS_SEEDS_PER_SLOT ||
      at == ADDRESS_SLOTS_PER_LINE ||
      at == ADDRESS_WINDOW_SLOTS ||
      at == ADDRESS_SLOTS_PER_MICROVECTOR ||
      at == ADDRESS_LINES_PER_REVOLUTION ||
      at == ADDRESS_POSITION_REVOLUTION ||
      at == ADDRESS_POSITION_LINE ||
      at == ADDRESS_SILENCE_LIMIT ||
      at == ADDRESS_FIRST_TICK ||
      at == ADDRESS_REVERSE_DELAY ||
      at == ADDRESS_LOW_LEVEL ||
      at == ADDRESS_CORRECTION_LIMIT ||
      at == ADDRESS_INDEX_WINDOW ||
      at == ADDRESS_REVOLUTION_SEEDS ||
      at == ADDRESS_REVOLUTION_SEEDS + 8'd1 ||
      at == ADDRESS_SCHEDULE_INCREMENT ||
      at == ADDRESS_SCHEDULE_SEEDS;
endfunction
// And like this before the first write.
function [31:0] reset_word(input [7:0] at);
  reset_word = 32'd0
      | {32{at == ADDRESS_PRESCALER}} & 32'h1
      | {32{at == ADDRESS_FRACTION_DEN}} & 32'h1
      | {32{at == ADDRESS_PRESCALER_1}} & 32'h1
      | {32{at == ADDRESS_FRACTION_DEN_1}} & 32'h1
      | {32{at == ADDRESS_SEEDS_PER_SLOT}} & 32'h1
      | {32{at == ADDRESS_SLOTS_PER_MICROVECTOR}} & 32'h1
      | {32{at == ADDRESS_LINES_PER_REVOLUTION}} & 32'h1
      | {32{at == ADDRESS_SILENCE_LIMIT}} & 32'h7d1f40
      | {32{at == ADDRESS_SCHEDULE_SEEDS}} & 32'h1;
endfunction
