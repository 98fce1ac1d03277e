// A-B generator: one channel of quadrature for a rotary or linear axis.
//
// A BITS wide counter adds `increment` on every `prescaler`-th clock; its two leading bits, Gray coded, are A and B
// ([B] eqs 1 and 2). A second accumulator of fraction_num / fraction_den carries +1 into the counter, so that every
// ratio is exact. On clocks that are multiples of the prescaler, counted from 1 after the load:
//   acc += num; carry = acc >= den; acc -= carry * den; count += increment + carry.
//
// load            takes all registers, starts a new count of clocks with acc = 0 and leaves the counter where it is
// load_increment  takes the increment alone; prescaler phase and acc go on, so a ramp has no gap
// refused         sticky until a load is taken or reset: a load that would move A and B together, or whose fraction is
//                 no proper one, or with prescaler 0, changes nothing
// enable          low: everything stands
//
// Latency: A and B come from flip-flops of their own, one clock after the counter (AB_LATENCY). Reset: all 0, standing.
`default_nettype none
module ab_generator #(
    parameter BITS = 32,
    parameter PRESCALER_BITS = 32,
    parameter FRACTION_BITS = 34
) (
    input wire clk,
    input wire rst,
    input wire enable,
    input wire load,
    input wire load_increment,
    input wire [BITS-1:0] increment,
    input wire [PRESCALER_BITS-1:0] prescaler,
    input wire [FRACTION_BITS-1:0] fraction_num,
    input wire [FRACTION_BITS-1:0] fraction_den,
    output reg a,
    output reg b,
    output reg refused,
    output reg [BITS-1:0] count
);
  localparam [BITS-1:0] QUARTER = {2'b01, {(BITS - 2) {1'b0}}};  // 2^(BITS-2)

  reg [BITS-1:0] step;
  reg [PRESCALER_BITS-1:0] period;
  reg [PRESCALER_BITS-1:0] phase;
  reg [FRACTION_BITS-1:0] num;
  reg [FRACTION_BITS-1:0] den_minus_num;
  reg [FRACTION_BITS-1:0] acc;

  wire fraction_ok = fraction_num < fraction_den;
  wire load_ok = fraction_ok && prescaler != 0 &&
                 (fraction_num == 0 ? increment <= QUARTER : increment < QUARTER);
  wire increment_ok = num == 0 ? increment <= QUARTER : increment < QUARTER;

  wire due = phase == period - 1'b1;
  wire carry = acc >= den_minus_num;
  wire [1:0] quarter = count[BITS-1:BITS-2];

  always @(posedge clk) begin
    if (rst) begin
      a <= 1'b0;
      b <= 1'b0;
      count <= 0;
      step <= 0;
      period <= 1;
      phase <= 0;
      num <= 0;
      den_minus_num <= 1;
      acc <= 0;
      refused <= 1'b0;
    end else begin
      a <= quarter[1];
      b <= quarter[1] ^ quarter[0];
      if (enable) begin
        phase <= due ? {PRESCALER_BITS{1'b0}} : phase + 1'b1;
        if (due) begin
          acc <= carry ? acc - den_minus_num : acc + num;
          count <= count + step + {{(BITS - 1) {1'b0}}, carry};
        end
      end
      if (load) begin
        refused <= !load_ok;
        if (load_ok) begin
          step <= increment;
          period <= prescaler;
          phase <= 0;
          num <= fraction_num;
          den_minus_num <= fraction_den - fraction_num;
          acc <= 0;
        end
      end else if (load_increment) begin
        refused <= !increment_ok;
        if (increment_ok) step <= increment;
      end
    end
  end

`ifdef FORMAL
  reg past_valid = 1'b0;
  reg past_a, past_b;
  always @(posedge clk) begin
    past_valid <= 1'b1;
    past_a <= a;
    past_b <= b;
  end
  reg [1:0] past_quarter;
  always @(posedge clk) past_quarter <= quarter;
  initial assume (rst);
  always @(*) if (past_valid) begin
    // What was loaded keeps the largest move within a quarter of the counter.
    assert (num == 0 ? step <= QUARTER : step < QUARTER);
    assert (acc < den_minus_num || acc - den_minus_num < num);  // acc < den, without the sum
    assert (num <= ~den_minus_num);                             // den fits
    assert (den_minus_num != 0);
    assert (period != 0 && phase < period);
    // A and B are the Gray code of the counter's last quarter, and never move together.
    assert (a == past_quarter[1] || past_rst);
    assert (b == (past_quarter[1] ^ past_quarter[0]) || past_rst);
  end
  reg past_rst = 1'b1;
  always @(posedge clk) past_rst <= rst;
  always @(*) if (past_valid && !past_rst) begin
    assert ((quarter - past_quarter) != 2'd2 && (quarter - past_quarter) != 2'd3);  // never back, never two
    assert (!((a != past_a) && (b != past_b)));
  end
`endif
endmodule
`default_nettype wire
