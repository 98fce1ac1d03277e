// A-B pacer: decides, one seed clock ahead, on which of the next two FPGA clocks a counter steps and by how much.
//
// Clocks of the FPGA (two a seed clock, CLOCK_MULTIPLIER) count from 1 after a load. On those that are multiples of the
// prescaler ([B] eqs 1 and 2, with a fraction that makes every ratio exact):
//   acc += num; carry = acc >= den; acc -= carry * den; count += increment + carry.
// Here the accumulator is x = K num mod den of the next step K, and its carry is x < num. With prescaler 1 both clocks
// step, so that two accumulators, x of the odd and y of the even steps, go on by addend = 2 num mod den each.
//
// enable          low: everything stands
// load            takes all registers, LOAD_CLOCKS seed clocks later; starts a new count with acc = 0
// load_increment  takes the increment alone, without a gap
// backward        the way the edges shall run; taken by a load alone
// busy            a load is under way; a load or load_increment now is refused
// refused         sticky until a load is taken or reset: a load that would move A and B together, or whose fraction is
//                 no proper one (or any, with FRACTION 0), or with prescaler 0, changes nothing
// due, carry      bit 0 the first FPGA clock, bit 1 the second; with them go `step`, the increment, and `back`
//
// Latency in seed clocks, from the one that takes an input to the one after which the output shows: enable to due
// DUE_LATENCY, load to the due of its clock 1 LOAD_CLOCKS, load_increment to step STEP_LATENCY. Reset: standing, increment 0.
`default_nettype none
module ab_pacer #(
    parameter BITS = 32,
    parameter PRESCALER_BITS = 32,
    parameter FRACTION_BITS = 34,
    parameter FRACTION = 1
) (
    input wire clk,
    input wire rst,
    input wire enable,
    input wire load,
    input wire backward,
    input wire load_increment,
    input wire [BITS-1:0] increment,
    input wire [PRESCALER_BITS-1:0] prescaler,
    input wire [FRACTION_BITS-1:0] fraction_num,
    input wire [FRACTION_BITS-1:0] fraction_den,
    output reg [1:0] due,
    output reg [1:0] carry,
    output reg [BITS-1:0] step,
    output reg back,
    output reg refused,
    output wire busy
);
  localparam P = PRESCALER_BITS;
  localparam F = FRACTION_BITS;
  localparam [P-1:0] TWO = 2;
  /* verilator lint_off UNUSEDPARAM */
  `include "latencies.vh"
  /* verilator lint_on UNUSEDPARAM */

  // A load passes LOAD_CLOCKS stages. 0: taken aside; 1, 2: checked; from 3 on: put in force, each at the stage that uses it, behind
  // the last word of the registers before.
  reg [LOAD_CLOCKS-1:0] loading;
  assign busy = loading != 0;
  reg [BITS-1:0] new_step;
  reg [P-1:0] new_period;
  reg [F-1:0] new_num;
  reg new_back, new_over, new_quarter, new_zero, new_one;
  reg [P-1:0] new_period_less;
  reg new_ok;
  wire any_low = increment[BITS-3:0] != 0;  // compared bit by bit with 2^(BITS-2): no long carry chain
  wire over = increment[BITS-1] || (increment[BITS-2] && any_low);
  wire quarter = !increment[BITS-1] && increment[BITS-2] && !any_low;

  reg has_fraction;   // of the registers that `step` belongs to
  reg word_fraction;  // and of those of the word that follows
  reg next_step_ok, next_step_bad;

  // Pace: FPGA clocks until the next step.
  reg [P-1:0] left, period, period_less;
  reg every;
  wire first_due = left == 1;
  wire second_due = left == 2 || (first_due && every);
  wire [1:0] paced;
  reg [1:0] pace_due;
  assign paced = {second_due, first_due} & {2{enable}};

  wire fraction_ok, fraction_off;
  wire [1:0] carried;
  reg [1:0] add_due, word_due;

  always @(posedge clk) begin
    if (rst) begin
      loading <= 0;
      left <= 1;
      period <= 1;
      period_less <= 0;
      every <= 1'b1;
      pace_due <= 2'd0;
      add_due <= 2'd0;
      word_due <= 2'd0;
      due <= 2'd0;
      carry <= 2'd0;
      step <= 0;
      back <= 1'b0;
      has_fraction <= 1'b0;
      word_fraction <= 1'b0;
      next_step_ok <= 1'b0;
      next_step_bad <= 1'b0;
      refused <= 1'b0;
      new_ok <= 1'b0;
    end else begin
      loading <= {loading[LOAD_CLOCKS-2:3], loading[2] && new_ok, loading[1:0], load && !busy};
      new_ok <= !new_over && !new_zero && fraction_ok && (fraction_off || !new_quarter);

      pace_due <= paced;
      if (loading[3]) begin
        left <= new_period;
        period <= new_period;
        period_less <= new_period_less;
        every <= new_one;
      end else if (enable) begin
        left <= first_due ? (every ? period : period_less) : left == 2 ? period : left - TWO;
      end
      add_due <= pace_due;
      word_due <= add_due;
      due <= word_due;
      carry <= carried & word_due & {2{word_fraction}};

      next_step_ok <= load_increment && !load && !busy && !over && !(quarter && has_fraction);
      next_step_bad <= (load_increment && !load && !busy && (over || (quarter && has_fraction))) ||
                       (busy && (load || load_increment));
      if (loading[LOAD_CLOCKS-1]) begin
        step <= new_step;
        back <= new_back;
        has_fraction <= !fraction_off;
      end else if (next_step_ok) step <= new_step;
      if (loading[LOAD_CLOCKS-2]) word_fraction <= !fraction_off;
      if (loading[2]) refused <= !new_ok;
      if (next_step_ok) refused <= 1'b0;
      if (next_step_bad) refused <= 1'b1;
    end
    if (!busy) new_step <= increment;  // a new increment alone waits for one clock here, too
    if (load && !busy) begin
      new_back <= backward;
      new_period <= prescaler;
      new_num <= fraction_num;
      new_over <= over;
      new_quarter <= quarter;
    end
    new_zero <= new_period == 0;
    new_one <= new_period == 1;
    new_period_less <= new_period - 1'b1;
  end

  generate
    if (FRACTION != 0) begin : with_fraction
      // With below = den - addend, the state of an accumulator is x - below, so that its sign alone tells what comes next:
      // x - below >= 0: x + addend - den, else x + addend. And x < num is x - below < num - below.
      reg [F:0] rest;             // den - num, with its sign
      reg [F:0] twice;            // 2 num - den, with its sign: num - rest
      reg [F-1:0] num_2, rest_2;  // 2 num mod den, and den less that
      reg [F:0] first_2, second_2;  // num - rest_2, num_2 - rest_2: where the two accumulators begin
      reg num_zero;
      reg [F:0] x, y, add_x, add_y, limit;
      reg [F-1:0] addend, below;
      reg two;
      reg [1:0] less;
      assign fraction_ok = !rest[F] && rest != 0;
      assign fraction_off = num_zero;
      assign carried = less;
      wire wraps = !twice[F];
      /* verilator lint_off UNUSEDSIGNAL */  // the lowest bit only makes a carry
      wire [F+1:0] next_x = {x, 1'b1} + (x[F] ? {1'b0, addend, 1'b0} : {1'b1, ~below, 1'b1});
      wire [F+1:0] next_y = {y, 1'b1} + (y[F] ? {1'b0, addend, 1'b0} : {1'b1, ~below, 1'b1});
      /* verilator lint_on UNUSEDSIGNAL */
      always @(posedge clk) begin
        if (load && !busy) rest <= {1'b0, fraction_den} - {1'b0, fraction_num};
        num_zero <= new_num == 0;
        twice <= {1'b0, new_num} - {1'b0, rest[F-1:0]};
        num_2 <= wraps ? twice[F-1:0] : {new_num[F-2:0], 1'b0};
        rest_2 <= wraps ? {rest[F-2:0], 1'b0} : {F{1'b0}} - twice[F-1:0];
        first_2 <= {1'b0, new_num} - {1'b0, rest_2};
        second_2 <= {1'b0, num_2} - {1'b0, rest_2};
        if (rst) begin
          x <= {(F + 1) {1'b1}};
          y <= {(F + 1) {1'b1}};
          limit <= {(F + 1) {1'b1}};
          addend <= 0;
          below <= 1;
          two <= 1'b1;
        end else begin
          if (loading[4]) begin
            x <= new_one ? first_2 : twice;
            y <= second_2;
            addend <= new_one ? num_2 : new_num;
            below <= new_one ? rest_2 : rest[F-1:0];
            two <= new_one;
          end else if (pace_due != 0) begin
            x <= next_x[F+1:1];
            y <= next_y[F+1:1];
          end
          if (loading[5]) limit <= new_one ? first_2 : twice;
        end
        add_x <= x;
        add_y <= two ? y : x;
        less <= {$signed(add_y) < $signed(limit), $signed(add_x) < $signed(limit)};
      end
    end else begin : without_fraction
      reg num_zero, no_den;
      assign fraction_ok = num_zero;
      assign fraction_off = num_zero;
      assign carried = 2'd0;
      always @(posedge clk) if (load && !busy) no_den <= fraction_den == 0;
      always @(posedge clk) num_zero <= new_num == 0 && !no_den;
`ifdef FORMAL
      always @(*) if (valid && busy) assert (no_den == (ref_new_den == 0));
`endif
    end
  endgenerate
`ifdef FORMAL
  localparam [BITS-1:0] QUARTER = {2'b01, {(BITS - 2) {1'b0}}};
  // The contract as it stands above, clock by clock, one FPGA clock after the other; `due` and `carry` follow it.
  reg [P-1:0] ref_phase, ref_period;
  reg [F-1:0] ref_acc, ref_num, ref_den;
  wire ref_due_0 = enable && ref_phase + 1'b1 == ref_period;
  wire [P-1:0] ref_phase_0 = ref_due_0 ? {P{1'b0}} : ref_phase + 1'b1;
  wire ref_due_1 = enable && ref_phase_0 + 1'b1 == ref_period;
  wire [P-1:0] ref_phase_1 = ref_due_1 ? {P{1'b0}} : ref_phase_0 + 1'b1;
  wire [F:0] ref_sum_0 = {1'b0, ref_acc} + (ref_due_0 ? {1'b0, ref_num} : {(F + 1) {1'b0}});
  wire ref_carry_0 = ref_sum_0 >= {1'b0, ref_den};
  wire [F:0] ref_acc_0 = ref_carry_0 ? ref_sum_0 - {1'b0, ref_den} : ref_sum_0;
  wire [F:0] ref_sum_1 = ref_acc_0 + (ref_due_1 ? {1'b0, ref_num} : {(F + 1) {1'b0}});
  wire ref_carry_1 = ref_sum_1 >= {1'b0, ref_den};
  wire [F:0] ref_acc_1 = ref_carry_1 ? ref_sum_1 - {1'b0, ref_den} : ref_sum_1;
  reg [F-1:0] ref_new_den;
  always @(posedge clk) if (load && !busy) ref_new_den <= fraction_den;
  reg [3:0] ref_word[0:DUE_LATENCY];  // what the output shows that many clocks later
  integer stage;
  reg valid = 1'b0;
  reg asked_back, past_back, past_taken;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    if (load && !busy) asked_back <= backward;
    past_back <= back && !rst;
    past_taken <= loading[LOAD_CLOCKS-1] && !rst;
    ref_word[0] <= {ref_carry_1, ref_carry_0, ref_due_1, ref_due_0};
    for (stage = 1; stage <= DUE_LATENCY; stage = stage + 1) ref_word[stage] <= ref_word[stage-1];
    if (rst) begin
      ref_phase <= 0;
      ref_period <= 1;
      ref_acc <= 0;
      ref_num <= 0;
      ref_den <= 1;
      for (stage = 0; stage <= DUE_LATENCY; stage = stage + 1) ref_word[stage] <= 4'd0;
    end else if (loading[3]) begin
      ref_phase <= 0;
      ref_period <= new_period;
      ref_acc <= 0;
      ref_num <= new_num;
      ref_den <= ref_new_den;
    end else if (enable) begin
      ref_phase <= ref_phase_1;
      ref_acc <= ref_acc_1[F-1:0];
    end
  end
  always @(*) if (valid) begin
    assert (step <= QUARTER);
    if (carry != 0) assert (step < QUARTER);  // so that A and B never move together
    assert ((carry & ~due) == 0);
    assert (back == (past_taken ? asked_back : past_back));  // as asked for by the last load that was not refused
    if (busy) assert (new_back == asked_back);
    // What makes that inductive: a load is checked before it is in force, and no fraction is added without one.
    assert ((loading & (loading - 1'b1)) == 0);
    if (busy) assert (new_over == (new_step > QUARTER) && new_quarter == (new_step == QUARTER));
    if (loading[LOAD_CLOCKS-1:1] != 0) assert (fraction_off == (new_num == 0 && (FRACTION != 0 || ref_new_den != 0)));
    if (loading[2]) assert (!new_ok || (!new_over && (fraction_off || !new_quarter)));
    if (loading[LOAD_CLOCKS-1:3] != 0) assert (!new_over && (fraction_off || !new_quarter));
    if (has_fraction) assert (step < QUARTER);
    if (!has_fraction) assert (carry == 0);
    if (next_step_ok) assert (new_step <= QUARTER && !(has_fraction && new_step == QUARTER) && loading[LOAD_CLOCKS-1:1] == 0);
    if (!loading[LOAD_CLOCKS-1]) assert (word_fraction == has_fraction);
    if (loading[LOAD_CLOCKS-1]) assert (word_fraction == !fraction_off);
`ifdef FORMAL_CONTRACT
    assert ({carry, due} == ref_word[DUE_LATENCY]);
`endif
  end
`endif
endmodule
`default_nettype wire
