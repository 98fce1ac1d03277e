// Synchro: the board's whole logic, registers.vh its map. All but the A-B accumulators runs at the seed clock `clk`;
// clk_fast is the FPGA clock, two a seed clock, an edge of it with every edge of clk.
//
// host bytes -> frame_parser -> line_fifo (bits) and line queue (first slot, direction) -> pulse_gate, paced by line_start,
// slot_divider, line_sequencer and direction_delay; line_progress says how far lines came; two axes by ab_generator, each
// with its increment_schedule; scanner_clock; index_reference lets the lines follow the axis; watchdog and fault_latch close
// the gate.
// Axis 1 has a fraction where FRACTION_1 is 1; with two the logic does not fit on an HX8K.
// Once lines have begun they follow without a gap for as long as slots run: the machine never waits, a line that is not
// there in time is an underrun.
// Fails dark: any fault, the interlock or a stop closes the gate; command bit 0 acknowledges, and drops all that was queued.
// To go on after a fault: read executed_lines and closed_slot, stop the slots, acknowledge, load the position, send lines
// (the first without the bits of the slots that have passed), run, start.
// Latency: a slot's first clock to `gate` is SLOT_TO_GATE seed clocks (divider, sequencer, delay, gate), to `scan`
// SLOT_TO_SCAN; an address to read_data READ_LATENCY (latencies.vh has all of these names). Reset: as the map says, dark, everything standing.
`default_nettype none
module synchro #(
    parameter FIFO_BITS = 12,
    parameter SCHEDULE_BITS = 8,
    parameter FRACTION_1 = 0
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
    input wire index,
    input wire interlock,
    output wire [31:0] read_data,
    output wire a,
    output wire b,
    output wire a_1,
    output wire b_1,
    output wire gate,
    output wire scan,
    output wire [2:0] fault
);
  wire [8:0] control;
  wire [9:0] command;
  wire run = control[0];
  wire acknowledge = command[0];

  wire [31:0] increment, prescaler, increment_1, prescaler_1, lines_per_revolution, position_revolution, position_line;
  wire [31:0] silence_limit, first_tick, schedule_increment, schedule_seeds;
  wire [33:0] fraction_num, fraction_den, fraction_num_1, fraction_den_1;
  wire [15:0] seeds_per_slot, reverse_delay, low_level, index_window;
  wire [23:0] slots_per_line, window_slots, slots_per_microvector;
  wire [7:0] correction_limit;
  wire [47:0] revolution_seeds;
  wire store, setting_refused;
  wire [7:0] store_address;
  wire [31:0] store_data;
  settings host_settings (
      .clk(clk), .rst(rst), .clear(acknowledge), .write(write), .address(address), .write_data(write_data),
      .control(control), .command(command), .increment(increment), .prescaler(prescaler), .fraction_num(fraction_num),
      .fraction_den(fraction_den), .increment_1(increment_1), .prescaler_1(prescaler_1), .fraction_num_1(fraction_num_1),
      .fraction_den_1(fraction_den_1), .seeds_per_slot(seeds_per_slot), .slots_per_line(slots_per_line),
      .window_slots(window_slots), .slots_per_microvector(slots_per_microvector),
      .lines_per_revolution(lines_per_revolution), .position_revolution(position_revolution),
      .position_line(position_line), .silence_limit(silence_limit), .first_tick(first_tick),
      .reverse_delay(reverse_delay), .low_level(low_level), .correction_limit(correction_limit),
      .index_window(index_window), .revolution_seeds(revolution_seeds), .schedule_increment(schedule_increment),
      .schedule_seeds(schedule_seeds), .store(store), .store_address(store_address), .store_data(store_data),
      .refused(setting_refused)
  );

  // The axes. A segment of a schedule goes before an increment of the host.
  wire [1:0] scheduled, schedule_busy, schedule_overflow, ab_refused;
  wire [31:0] scheduled_increment, scheduled_increment_1;
  reg schedules_run;
  always @(posedge clk) schedules_run <= !rst && !command[9] && (schedules_run || command[6]);
  /* verilator lint_off PINCONNECTEMPTY */
  increment_schedule #(.ADDRESS_BITS(SCHEDULE_BITS)) schedule (
      .clk(clk), .rst(rst), .flush(command[9]), .run(schedules_run), .push(command[7]),
      .push_increment(schedule_increment), .push_clocks(schedule_seeds), .load_increment(scheduled[0]),
      .increment(scheduled_increment), .busy(schedule_busy[0]), .full(), .overflow(schedule_overflow[0])
  );
  increment_schedule #(.ADDRESS_BITS(SCHEDULE_BITS)) schedule_1 (
      .clk(clk), .rst(rst), .flush(command[9]), .run(schedules_run), .push(command[8]),
      .push_increment(schedule_increment), .push_clocks(schedule_seeds), .load_increment(scheduled[1]),
      .increment(scheduled_increment_1), .busy(schedule_busy[1]), .full(), .overflow(schedule_overflow[1])
  );
  ab_generator axis (
      .clk(clk), .clk_fast(clk_fast), .rst(rst), .enable(control[1]), .load(command[1]), .backward(control[7]),
      .load_increment(command[2] || scheduled[0]), .increment(scheduled[0] ? scheduled_increment : increment),
      .prescaler(prescaler), .fraction_num(fraction_num), .fraction_den(fraction_den), .a(a), .b(b),
      .refused(ab_refused[0]), .busy()
  );
  ab_generator #(.FRACTION(FRACTION_1)) axis_1 (
      .clk(clk), .clk_fast(clk_fast), .rst(rst), .enable(control[3]), .load(command[4]), .backward(control[8]),
      .load_increment(command[5] || scheduled[1]), .increment(scheduled[1] ? scheduled_increment_1 : increment_1),
      .prescaler(prescaler_1), .fraction_num(fraction_num_1), .fraction_den(fraction_den_1), .a(a_1), .b(b_1),
      .refused(ab_refused[1]), .busy()
  );

  // From the host to whole lines.
  wire push, commit, rollback, line_valid, sequence_error, shape_error, checksum_error;
  wire [7:0] push_data;
  wire [23:0] first_slot;
  wire line_is_odd;
  frame_parser parser (
      .clk(clk), .rst(rst), .clear(acknowledge), .in_valid(in_valid), .in_data(in_data),
      .slots_per_line(slots_per_line), .window_slots(window_slots), .lines_per_revolution(lines_per_revolution),
      .position_load(command[3]), .position_revolution(position_revolution), .position_line(position_line),
      .push(push), .push_data(push_data), .commit(commit), .rollback(rollback), .line_valid(line_valid),
      .first_slot(first_slot), .odd(line_is_odd), .sequence_error(sequence_error), .shape_error(shape_error),
      .checksum_error(checksum_error), .revolution(), .line()
  );

  wire byte_valid, byte_take, overflow, almost_empty;
  wire [7:0] byte_data;
  wire [FIFO_BITS+1:0] level;
  wire [FIFO_BITS+1:0] low = low_level >> (FIFO_BITS + 2) != 0 ? {(FIFO_BITS + 2) {1'b1}} : low_level[FIFO_BITS+1:0];
  line_fifo #(.W(8), .ADDRESS_BITS(FIFO_BITS)) bits (
      .clk(clk), .rst(rst), .flush(acknowledge), .push(push), .push_data(push_data), .commit(commit),
      .rollback(rollback), .pop(byte_take), .low_level(low), .valid(byte_valid), .data(byte_data), .level(level),
      .almost_empty(almost_empty), .full(), .overflow(overflow)
  );

  // One entry a committed line, committed one clock after it was pushed.
  reg queue_commit;
  always @(posedge clk) queue_commit <= line_valid && !rst;
  wire queue_valid, queue_overflow, line_first, queue_odd;
  wire [23:0] queue_first_slot;
  line_fifo #(.W(25), .ADDRESS_BITS(4)) queue (
      .clk(clk), .rst(rst), .flush(acknowledge), .push(line_valid), .push_data({line_is_odd, first_slot}),
      .commit(queue_commit), .rollback(1'b0), .pop(line_first), .low_level(6'd0), .valid(queue_valid),
      .data({queue_odd, queue_first_slot}), .level(), .almost_empty(), .full(), .overflow(queue_overflow)
  );

  // Slots and lines.
  wire slots_run, started, slot, adjust;
  wire [8:0] amount;
  line_start starter (
      .clk(clk), .rst(rst), .run(run), .timed(control[4]), .strobe(start), .go(command[6]), .first_tick(first_tick),
      .slots_run(slots_run), .started(started)
  );
  slot_divider slots (
      .clk(clk), .rst(rst), .run(slots_run), .seeds_per_slot(seeds_per_slot), .adjust(adjust), .amount(amount),
      .slot(slot)
  );
  wire line_slot, line_decision, line_window, line_last, running;
  wire missing = slot && started && !running && slots_per_line != 0 && !queue_valid;
  line_sequencer #(.W(24)) sequencer (
      .clk(clk), .rst(rst || !run), .slot(slot), .start(started), .slots_per_line(slots_per_line),
      .first_slot(queue_first_slot), .window_slots(window_slots), .slot_out(line_slot), .decision(line_decision),
      .window(line_window), .first(line_first), .last(line_last), .running(running)
  );
  scanner_clock #(.W(24)) scanner (
      .clk(clk), .rst(rst), .decision(line_decision), .first(line_first), .slots_per_microvector(slots_per_microvector),
      .scan(scan)
  );
  wire [17:0] index_error;
  wire referenced, index_lost;
  index_reference reference (
      .clk(clk), .rst(rst), .clear(acknowledge), .enable(control[6] && run), .index(index), .line_end(line_last),
      .revolution(revolution_seeds), .window(index_window), .limit(correction_limit), .adjust(adjust), .amount(amount),
      .error(index_error), .referenced(referenced), .lost(index_lost)
  );

  // The gate. A line that is missing closes it when the slot before it is over.
  wire gate_slot, decision, window, first, last;
  direction_delay directions (
      .clk(clk), .rst(rst || !run), .delay(reverse_delay), .reverse(queue_odd && control[5]), .slot_in(line_slot),
      .decision_in(line_decision), .window_in(line_window), .first_in(line_first), .last_in(line_last),
      .slot(gate_slot), .decision(decision), .window(window), .first(first), .last(last)
  );
  reg line_missing, was_missing;
  always @(posedge clk) begin
    line_missing <= missing && !rst && !acknowledge;
    was_missing <= line_missing && !rst && !acknowledge;
  end
  wire underrun, dark, silent, any_fault, passed, open;
  reg stream_error;  // anything wrong with what the host sent
  always @(posedge clk)
    stream_error <= !rst && !acknowledge &&
                    (overflow || queue_overflow || sequence_error || shape_error || checksum_error);
  wire close = interlock || (!acknowledge && (any_fault || was_missing || silent || stream_error));
  pulse_gate pulses (
      .clk(clk), .rst(rst), .run(run), .clear(acknowledge), .fault(close), .slot(gate_slot), .decision(decision),
      .window(window), .first(first), .last(last), .byte_valid(byte_valid), .byte_data(byte_data), .gate(gate),
      .byte_take(byte_take), .underrun(underrun), .dark(dark), .passed(passed), .open(open)
  );
  wire [31:0] executed_lines;
  wire [23:0] passed_slots;
  wire partial_line;
  line_progress progress (
      .clk(clk), .rst(rst), .clear(acknowledge), .load(command[3]), .run(run), .begins(line_first), .queued(queue_valid),
      .slot(gate_slot), .passed(passed), .open(open), .dark(dark), .executed(executed_lines), .slots(passed_slots),
      .partial(partial_line)
  );

  // Faults.
  wire [5:0] faults_seen;
  watchdog host (
      .clk(clk), .rst(rst), .enable(control[2]), .kick(in_valid || write), .clear(acknowledge), .limit(silence_limit),
      .expired(silent)
  );
  fault_latch faults (
      .clk(clk), .rst(rst), .acknowledge(acknowledge), .sequence_error(sequence_error && !acknowledge),
      .checksum_error(checksum_error && !acknowledge),
      .shape_error((shape_error || overflow || queue_overflow) && !acknowledge),
      .underrun((underrun || was_missing) && !acknowledge), .host_silence(silent && !acknowledge),
      .interlock(interlock), .fault(fault), .seen(faults_seen), .any(any_fault)
  );

  wire [15:0] status = {referenced, almost_empty, started, index_lost, setting_refused, schedule_overflow != 0,
                        schedule_busy, ab_refused[1], overflow || queue_overflow, ab_refused[0], running, dark, fault};
  register_read #(.FIFO_BITS(FIFO_BITS)) reader (
      .clk(clk), .rst(rst), .address(address), .status(status), .level(level), .faults(faults_seen),
      .index_error(index_error), .executed_lines(executed_lines), .closed_slot({partial_line, 7'd0, passed_slots}),
      .store(store), .store_address(store_address), .store_data(store_data),
      .read_data(read_data)
  );
  /* verilator lint_on PINCONNECTEMPTY */

`ifdef FORMAL_TOP
  // How the blocks are wired: whatever the host and the pins do, one clock after reset, a stop, an open interlock, any
  // fault, a dark gate or an acknowledge the gate is closed; and it opens by a bit of a line in its window alone. Two clocks
  // after a fault has shown, how far the lines came stands.
  reg valid = 1'b0, must_close, may_open, was_gate, was_fault;
  reg [1:0] stood = 2'd0;  // clocks of a fault
  reg [56:0] past_progress;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    must_close <= rst || !run || interlock || fault != 0 || dark || acknowledge;
    may_open <= gate_slot && decision && window;
    was_gate <= gate;
    was_fault <= fault != 0 && !rst && !acknowledge;
    stood <= fault == 0 || rst || acknowledge || command[3] ? 2'd0 : stood + (stood != 2'd3);
    past_progress <= {executed_lines, partial_line, passed_slots};
  end
  always @(*) if (valid) begin
    if (must_close) assert (!gate);
    if (gate && !was_gate) assert (may_open);
    if (was_fault) assert (fault != 0);  // sticky until it is acknowledged
    if (stood == 2'd3) assert (past_progress == {executed_lines, partial_line, passed_slots});
  end
`endif
endmodule
`default_nettype wire
