// Made by fpga/regs/generate.py from blocks.txt; change that file.
6'd0: word <= 32'h01030020;  // A-B generator, axis 0: 32 counter bits
6'd1: word <= 32'h01030020;  // A-B generator, axis 1: 32 counter bits
6'd2: word <= 32'h02010022;  // fraction of axis 0: 34 bits
6'd3: word <= 32'h03020100;  // increment schedule, axis 0: 256 segments
6'd4: word <= 32'h03020100;  // increment schedule, axis 1: 256 segments
6'd5: word <= 32'h0402000c;  // line FIFO: 12 2^size bytes
6'd6: word <= 32'h05020010;  // line queue: 16 lines
6'd7: word <= 32'h06030018;  // slots and lines: 24 bits of np; k has 16
6'd8: word <= 32'h07010010;  // direction delay: 16 bits
6'd9: word <= 32'h08010030;  // index reference: 48 bits of a revolution
6'd10: word <= 32'h09020018;  // scanner clock: 24 bits
6'd11: word <= 32'h0a010020;  // watchdog: 32 bits
