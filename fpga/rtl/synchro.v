// Synchro: the board's whole logic, registers.vh its map. All but the A-B accumulator runs at the seed clock `clk`;
// clk_fast is the FPGA clock, two a seed clock, an edge of it with every edge of clk.
//
// host bytes -> frame_parser -> line_fifo (bits) and line queue (first slots) -> pulse_gate, paced by slot_divider and
// line_sequencer; the axis by ab_generator; scanner_clock; watchdog and fault_latch close the gate.
// Lines begin at the first slot after `start` was seen while slots run, and then follow without a gap for as long as they
// run: the machine never waits, a line that is not there in time is an underrun.
// Fails dark: any fault, the interlock or a stop closes the gate; command bit 0 acknowledges, and drops all that was queued.
// To go on after a fault: stop the slots, acknowledge, load the position, send lines, run, start.
// Latency: a slot's first tick to `gate` is three clocks (SLOT_TO_GATE: divider, sequencer, gate). Reset: as the map says,
// dark, everything standing.
`default_nettype none
module synchro #(
    parameter FIFO_BITS = 12
) (
    input wire clk,
    input wire clk_fast,
    input wire rst,
    input wire write,
    input wire [7:0] address,
    input wire [31:0] write_data,
    input wire in_valid,
    input wire [7:0] in_data,
    input wire start,
    input wire interlock,
    output reg [31:0] read_data,
    output wire a,
    output wire b,
    output wire gate,
    output wire scan,
    output wire [2:0] fault
);
  /* verilator lint_off UNUSEDPARAM */
  `include "registers.vh"
  /* verilator lint_on UNUSEDPARAM */

  // Registers.
  reg [2:0] control;
  reg [3:0] command;
  reg [31:0] increment, prescaler;
  reg [33:0] fraction_num, fraction_den;
  reg [31:0] num_low, den_low;  // low words wait for their high ones
  reg [15:0] ticks_per_slot, slots_per_line, window_slots, slots_per_microvector;
  reg [31:0] lines_per_revolution, position_revolution, position_line, silence_limit;
  wire run = control[0];
  wire acknowledge = command[0];

  always @(posedge clk) begin
    command <= 4'd0;
    if (rst) begin
      control <= RESET_CONTROL;
      increment <= RESET_INCREMENT;
      prescaler <= RESET_PRESCALER;
      fraction_num <= RESET_FRACTION_NUM;
      fraction_den <= RESET_FRACTION_DEN;
      num_low <= 0;
      den_low <= 0;
      ticks_per_slot <= RESET_TICKS_PER_SLOT;
      slots_per_line <= RESET_SLOTS_PER_LINE;
      window_slots <= RESET_WINDOW_SLOTS;
      slots_per_microvector <= RESET_SLOTS_PER_MICROVECTOR;
      lines_per_revolution <= RESET_LINES_PER_REVOLUTION;
      position_revolution <= RESET_POSITION_REVOLUTION;
      position_line <= RESET_POSITION_LINE;
      silence_limit <= RESET_SILENCE_LIMIT;
    end else if (write) begin
      case (address)
        ADDRESS_CONTROL: control <= write_data[2:0];
        ADDRESS_COMMAND: command <= write_data[3:0];
        ADDRESS_INCREMENT: increment <= write_data;
        ADDRESS_PRESCALER: prescaler <= write_data;
        ADDRESS_FRACTION_NUM: num_low <= write_data;
        ADDRESS_FRACTION_NUM + 8'd1: fraction_num <= {write_data[1:0], num_low};
        ADDRESS_FRACTION_DEN: den_low <= write_data;
        ADDRESS_FRACTION_DEN + 8'd1: fraction_den <= {write_data[1:0], den_low};
        ADDRESS_TICKS_PER_SLOT: ticks_per_slot <= write_data[15:0];
        ADDRESS_SLOTS_PER_LINE: slots_per_line <= write_data[15:0];
        ADDRESS_WINDOW_SLOTS: window_slots <= write_data[15:0];
        ADDRESS_SLOTS_PER_MICROVECTOR: slots_per_microvector <= write_data[15:0];
        ADDRESS_LINES_PER_REVOLUTION: lines_per_revolution <= write_data;
        ADDRESS_POSITION_REVOLUTION: position_revolution <= write_data;
        ADDRESS_POSITION_LINE: position_line <= write_data;
        ADDRESS_SILENCE_LIMIT: silence_limit <= write_data;
        default: ;
      endcase
    end
  end

  // The axis.
  wire ab_refused;
  /* verilator lint_off PINCONNECTEMPTY */
  ab_generator axis (
      .clk(clk), .clk_fast(clk_fast), .rst(rst), .enable(control[1]), .load(command[1]), .load_increment(command[2]), .increment(increment),
      .prescaler(prescaler), .fraction_num(fraction_num), .fraction_den(fraction_den), .a(a), .b(b),
      .refused(ab_refused), .busy()
  );

  // From the host to whole lines.
  wire push, commit, rollback, line_valid, sequence_error, shape_error, checksum_error;
  wire [7:0] push_data;
  wire [15:0] first_slot;
  frame_parser parser (
      .clk(clk), .rst(rst), .clear(acknowledge), .in_valid(in_valid), .in_data(in_data),
      .slots_per_line(slots_per_line), .window_slots(window_slots), .lines_per_revolution(lines_per_revolution),
      .position_load(command[3]), .position_revolution(position_revolution), .position_line(position_line),
      .push(push), .push_data(push_data), .commit(commit), .rollback(rollback), .line_valid(line_valid),
      .first_slot(first_slot), .sequence_error(sequence_error), .shape_error(shape_error),
      .checksum_error(checksum_error), .revolution(), .line()
  );

  wire byte_valid, byte_take, overflow;
  wire [7:0] byte_data;
  wire [FIFO_BITS+1:0] level;
  line_fifo #(.W(8), .ADDRESS_BITS(FIFO_BITS)) bits (
      .clk(clk), .rst(rst), .flush(acknowledge), .push(push), .push_data(push_data), .commit(commit),
      .rollback(rollback), .pop(byte_take), .valid(byte_valid), .data(byte_data), .low_level({(FIFO_BITS + 2) {1'b0}}), .level(level), .almost_empty(), .full(),
      .overflow(overflow)
  );

  // One entry a committed line: its first slot, committed one clock after it was pushed.
  reg queue_commit;
  always @(posedge clk) queue_commit <= line_valid && !rst;
  wire queue_valid, queue_overflow, first;
  wire [15:0] queue_first_slot;
  line_fifo #(.W(16), .ADDRESS_BITS(4)) queue (
      .clk(clk), .rst(rst), .flush(acknowledge), .push(line_valid), .push_data(first_slot), .commit(queue_commit),
      .rollback(1'b0), .pop(first), .valid(queue_valid), .data(queue_first_slot), .low_level(6'd0), .level(), .almost_empty(), .full(),
      .overflow(queue_overflow)
  );

  // Slots, lines, gate.
  wire slot, slot_out, decision, window, last, running;
  slot_divider slots (.clk(clk), .rst(rst), .run(run), .ticks_per_slot(ticks_per_slot), .slot(slot));

  reg started;
  always @(posedge clk) started <= !rst && run && (started || start);
  wire missing = slot && started && !running && slots_per_line != 0 && !queue_valid;
  line_sequencer sequencer (
      .clk(clk), .rst(rst || !run), .slot(slot), .start(started), .slots_per_line(slots_per_line),
      .first_slot(queue_first_slot), .window_slots(window_slots), .slot_out(slot_out), .decision(decision),
      .window(window), .first(first), .last(last), .running(running)
  );

  reg was_missing;  // in step with the sequencer's outputs: the line before keeps its last slot whole
  always @(posedge clk) was_missing <= missing && !rst && !acknowledge;
  wire underrun, dark, silent, any_fault;
  wire close = interlock || (!acknowledge && (any_fault || was_missing || silent || overflow || queue_overflow ||
                                              sequence_error || shape_error || checksum_error));
  pulse_gate pulses (
      .clk(clk), .rst(rst), .run(run), .clear(acknowledge), .fault(close), .slot(slot_out), .decision(decision),
      .window(window), .first(first), .last(last), .byte_valid(byte_valid), .byte_data(byte_data), .gate(gate),
      .byte_take(byte_take), .underrun(underrun), .dark(dark)
  );
  scanner_clock scanner (
      .clk(clk), .rst(rst), .decision(decision), .first(first), .slots_per_microvector(slots_per_microvector),
      .scan(scan)
  );

  // Faults.
  watchdog host (
      .clk(clk), .rst(rst), .enable(control[2]), .kick(in_valid || write), .clear(acknowledge), .limit(silence_limit),
      .expired(silent)
  );
  fault_latch faults (
      .clk(clk), .rst(rst), .acknowledge(acknowledge), .sequence_error(sequence_error && !acknowledge),
      .checksum_error(checksum_error && !acknowledge),
      .shape_error((shape_error || overflow || queue_overflow) && !acknowledge),
      .underrun((underrun || was_missing) && !acknowledge), .host_silence(silent && !acknowledge),
      .interlock(interlock), .fault(fault), .any(any_fault)
  );

  always @(posedge clk) begin
    case (address)
      ADDRESS_MAGIC: read_data <= RESET_MAGIC;
      ADDRESS_VERSION: read_data <= RESET_VERSION;
      ADDRESS_COUNTER_BITS: read_data <= {24'd0, RESET_COUNTER_BITS};
      ADDRESS_FIFO_BITS: read_data <= FIFO_BITS;
      ADDRESS_CLOCK_MULTIPLIER: read_data <= {24'd0, RESET_CLOCK_MULTIPLIER};
      ADDRESS_CONTROL: read_data <= {29'd0, control};
      ADDRESS_STATUS: read_data <= {25'd0, overflow || queue_overflow, ab_refused, running, dark, fault};
      ADDRESS_FIFO_LEVEL: read_data <= {{(30 - FIFO_BITS) {1'b0}}, level};
      ADDRESS_INCREMENT: read_data <= increment;
      ADDRESS_PRESCALER: read_data <= prescaler;
      ADDRESS_FRACTION_NUM: read_data <= fraction_num[31:0];
      ADDRESS_FRACTION_NUM + 8'd1: read_data <= {30'd0, fraction_num[33:32]};
      ADDRESS_FRACTION_DEN: read_data <= fraction_den[31:0];
      ADDRESS_FRACTION_DEN + 8'd1: read_data <= {30'd0, fraction_den[33:32]};
      ADDRESS_TICKS_PER_SLOT: read_data <= {16'd0, ticks_per_slot};
      ADDRESS_SLOTS_PER_LINE: read_data <= {16'd0, slots_per_line};
      ADDRESS_WINDOW_SLOTS: read_data <= {16'd0, window_slots};
      ADDRESS_SLOTS_PER_MICROVECTOR: read_data <= {16'd0, slots_per_microvector};
      ADDRESS_LINES_PER_REVOLUTION: read_data <= lines_per_revolution;
      ADDRESS_POSITION_REVOLUTION: read_data <= position_revolution;
      ADDRESS_POSITION_LINE: read_data <= position_line;
      ADDRESS_SILENCE_LIMIT: read_data <= silence_limit;
      default: read_data <= 32'd0;
    endcase
    if (rst) read_data <= 32'd0;
  end
endmodule
`default_nettype wire
