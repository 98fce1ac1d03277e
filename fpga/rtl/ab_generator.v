// A-B generator: one channel of quadrature for a rotary or linear axis.
//
// ab_pacer at the seed clock `clk` decides what every FPGA clock adds, ab_accumulator at the FPGA clock `clk_fast` adds
// it. Every rising edge of clk is one of clk_fast, every second of them (CLOCK_MULTIPLIER = 2): one PLL makes both.
// All inputs, `refused` and `busy` belong to clk; ab_pacer says what they mean.
//
// Latency in FPGA clocks, with S = BITS / SEGMENT: what is known of the counter just after clock c of a load shows on the
// pins c + 2 LOAD_CLOCKS + WORD_STAGES + S - 1 clocks after the load; enable acts 2 DUE_LATENCY + WORD_STAGES + S clocks
// later, a new increment 2 STEP_LATENCY + WORD_STAGES + S. The pins are flip-flops. Reset (one clk or longer): all 0, standing,
// forward. `backward` is taken by a load, which keeps the counter: from its first word on the edges run the other way.
`default_nettype none
module ab_generator #(
    parameter BITS = 32,
    parameter PRESCALER_BITS = 32,
    parameter FRACTION_BITS = 34,
    parameter FRACTION = 1,
    parameter SEGMENT = 8
) (
    input wire clk,
    input wire clk_fast,
    input wire rst,
    input wire enable,
    input wire load,
    input wire backward,
    input wire load_increment,
    input wire [BITS-1:0] increment,
    input wire [PRESCALER_BITS-1:0] prescaler,
    input wire [FRACTION_BITS-1:0] fraction_num,
    input wire [FRACTION_BITS-1:0] fraction_den,
    output wire a,
    output wire b,
    output wire refused,
    output wire busy
);
  wire [1:0] due, carry;
  wire [BITS-1:0] step;
  wire back;
  ab_pacer #(
      .BITS(BITS), .PRESCALER_BITS(PRESCALER_BITS), .FRACTION_BITS(FRACTION_BITS), .FRACTION(FRACTION)
  ) pacer (
      .clk(clk), .rst(rst), .enable(enable), .load(load), .backward(backward), .load_increment(load_increment),
      .increment(increment), .prescaler(prescaler), .fraction_num(fraction_num), .fraction_den(fraction_den), .due(due),
      .carry(carry), .step(step), .back(back), .refused(refused), .busy(busy)
  );

  reg beat, clear;
  always @(posedge clk) begin
    beat <= !rst && !beat;
    clear <= rst;
  end

  ab_accumulator #(.BITS(BITS), .SEGMENT(SEGMENT)) accumulator (
      .clk(clk_fast), .clear(clear), .beat(beat), .due(due), .carry(carry), .step(step), .back(back), .a(a),
      .b(b)
  );
endmodule
`default_nettype wire
