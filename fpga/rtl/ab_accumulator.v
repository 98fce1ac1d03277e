// A-B accumulator: the counter of an A-B channel at the FPGA clock, and its two pins.
//
// The BITS wide counter adds step + carry on every FPGA clock that is due; its two leading bits, Gray coded, are A and B.
// Words that go with `back` exchange the pins, so that their edges run the other way; where A and B differ when the way
// turns, both are inverted, too, which keeps them as they are: to turn makes no edge and loses none.
// To close at two FPGA clocks a seed clock it adds in segments of SEGMENT bits, each one clock behind the one below it,
// without feedback: only what is added passes from segment to segment.
//
// due, carry, step, back  from flip-flops of the seed clock (ab_pacer); bit 0 is for the first of its two
//                   FPGA clocks
// beat              turns over with every seed clock; tells the first FPGA clock from the second
// clear             sets the counter to 0
//
// Latency: from the seed clock that shows a word to the pins WORD_STAGES + BITS / SEGMENT FPGA clocks for its
// first bit, one more for its second. Reset: by clear, for one seed clock or longer.
`default_nettype none
module ab_accumulator #(
    parameter BITS = 32,
    parameter SEGMENT = 8
) (
    input wire clk,
    input wire clear,
    input wire beat,
    input wire [1:0] due,
    input wire [1:0] carry,
    input wire [BITS-1:0] step,
    input wire back,
    output reg a,
    output reg b
);
  localparam SEGMENTS = BITS / SEGMENT;

  reg was_beat, clear_now, due_now, carry_now;
  reg [BITS-1:0] step_now;
  wire first = beat != was_beat;
  always @(posedge clk) begin
    was_beat <= beat;
    clear_now <= clear;
    due_now <= first ? due[0] : due[1];
    carry_now <= first ? carry[0] : carry[1];
    step_now <= step;
  end

  // What is to be added; segment s finds its part s clocks later.
  reg carry_in;
  wire [SEGMENTS-1:0] overflow;
  assign overflow[0] = carry_in;
  always @(posedge clk) carry_in <= carry_now && due_now && !clear_now;

  wire [1:0] quarter;
  genvar s;
  generate
    for (s = 0; s < SEGMENTS; s = s + 1) begin : segment
      reg [SEGMENT*(s+1)-1:0] add;  // the latest on top
      reg [SEGMENT-1:0] sum;
      wire [SEGMENT-1:0] newest = due_now ? step_now[SEGMENT*s+:SEGMENT] : {SEGMENT{1'b0}};
      if (s == 0) begin : no_wait
        always @(posedge clk) add <= clear_now ? {SEGMENT{1'b0}} : newest;
      end else begin : waits
        always @(posedge clk) add <= clear_now ? {(SEGMENT * (s + 1)) {1'b0}} : {newest, add[SEGMENT*(s+1)-1:SEGMENT]};
      end
      if (s == SEGMENTS - 1) begin : leading
        assign quarter = sum[SEGMENT-1:SEGMENT-2];
        always @(posedge clk) sum <= clear_now ? {SEGMENT{1'b0}} : sum + add[SEGMENT-1:0] + {{(SEGMENT-1){1'b0}}, overflow[s]};
      end else begin : below
        reg overflowed;
        assign overflow[s+1] = overflowed;
        always @(posedge clk) begin
          if (clear_now) {overflowed, sum} <= 0;
          else {overflowed, sum} <= {1'b0, sum} + {1'b0, add[SEGMENT-1:0]} + {{SEGMENT{1'b0}}, overflow[s]};
        end
      end
    end
  endgenerate

  // The way of what the leading segment adds next, and of what it has added.
  reg [SEGMENTS:0] backs;  // that of step_now on top
  reg turned, inverted;
  always @(posedge clk) begin
    backs[SEGMENTS] <= back;
    backs[SEGMENTS-1:0] <= clear_now ? {SEGMENTS{1'b0}} : backs[SEGMENTS:1];
    turned <= !clear_now && backs[0];
    inverted <= !clear_now && (inverted ^ ((backs[0] ^ turned) && quarter[0]));
    a <= !clear_now && (quarter[1] ^ (turned && quarter[0]) ^ inverted);
    b <= !clear_now && (quarter[1] ^ (!turned && quarter[0]) ^ inverted);
  end
`ifdef FORMAL
  // A plain counter, and how the segments follow it. The word of every clock keeps the promise of ab_pacer.
  reg [BITS-1:0] past_add[0:SEGMENTS-1];    // 0: what segment 0 adds now
  reg [BITS-1:0] past_count[0:SEGMENTS-1];  // 0: what segment 0 shows now
  reg [SEGMENTS-1:0] past_carry;
  reg [SEGMENTS-1:0] past_overflow[0:SEGMENTS-1];  // out of the segments below s, for that count
  reg [1:0] past_quarter;
  reg past_clear = 1'b1, past_a, past_b, valid = 1'b0;
  // Quarter turns up and down; and whether all words since the last clear went one way.
  reg [SEGMENTS-1:0] past_back;  // as past_add
  reg [1:0] ref_turn, past_turn;
  reg all_forward, all_back, past_forward, past_backward;
  wire [1:0] moved = past_count[SEGMENTS-2][BITS-1:BITS-2] - ref_quarter;
  localparam [BITS-1:0] QUARTER = {2'b01, {(BITS - 2) {1'b0}}};
  wire [SEGMENTS-1:0] next_overflow;
  wire [1:0] ref_quarter = past_count[SEGMENTS-1][BITS-1:BITS-2];
  initial assume (clear_now);
  always @(*) assume (!due_now || (step_now <= QUARTER && !(carry_now && step_now == QUARTER)));
  integer i;
  always @(posedge clk) begin
    valid <= 1'b1;
    past_clear <= clear_now;
    past_a <= a;
    past_b <= b;
    past_quarter <= ref_quarter;
    past_add[0] <= due_now ? step_now : {BITS{1'b0}};
    past_count[0] <= past_count[0] + past_add[0] + {{(BITS - 1) {1'b0}}, carry_in};
    past_carry[1] <= carry_in;
    past_back <= {past_back[SEGMENTS-2:0], backs[SEGMENTS]};
    ref_turn <= past_back[SEGMENTS-1] ? ref_turn - moved : ref_turn + moved;
    past_turn <= ref_turn;
    all_forward <= all_forward && !past_back[SEGMENTS-1];
    all_back <= all_back && past_back[SEGMENTS-1];
    past_forward <= all_forward;
    past_backward <= all_back;
    past_overflow[0] <= next_overflow;
    for (i = 1; i < SEGMENTS; i = i + 1) begin
      past_add[i] <= past_add[i-1];
      if (i > 1) past_carry[i] <= past_carry[i-1];
      past_count[i] <= past_count[i-1];
      past_overflow[i] <= past_overflow[i-1];
    end
    if (clear_now) begin
      for (i = 0; i < SEGMENTS; i = i + 1) begin
        past_add[i] <= 0;
        past_count[i] <= 0;
        past_overflow[i] <= 0;
        past_carry[i] <= 1'b0;
      end
      past_back <= 0;
      ref_turn <= 2'd0;
      all_forward <= 1'b1;
      all_back <= 1'b1;
    end
  end
  genvar w;
  generate
    for (s = 1; s < SEGMENTS; s = s + 1) begin : history
      always @(*) if (valid) begin
        assert (past_count[s-1] == past_count[s] + past_add[s] + {{(BITS - 1) {1'b0}}, past_carry[s]});
        assert (past_add[s] <= QUARTER && !(past_carry[s] && past_add[s] == QUARTER));
      end
      for (w = 1; w < SEGMENTS; w = w + 1) begin : carries
        wire [SEGMENT*w:0] low = {1'b0, past_count[s][SEGMENT*w-1:0]} + {1'b0, past_add[s][SEGMENT*w-1:0]} +
                                 {{(SEGMENT * w) {1'b0}}, past_carry[s]};
        always @(*) if (valid) assert (past_overflow[s-1][w] == low[SEGMENT*w]);
      end
    end
    for (s = 0; s < SEGMENTS; s = s + 1) begin : follows
      if (s > 0) begin : carries
        wire [SEGMENT*s:0] low = {1'b0, past_count[0][SEGMENT*s-1:0]} + {1'b0, past_add[0][SEGMENT*s-1:0]} +
                                 {{(SEGMENT * s) {1'b0}}, carry_in};
        assign next_overflow[s] = low[SEGMENT*s];
        always @(*) if (valid) assert (overflow[s] == past_overflow[s-1][s]);
      end else begin : none
        assign next_overflow[s] = 1'b0;
      end
      for (w = 0; w <= s; w = w + 1) begin : waiting
        always @(*) if (valid) assert (segment[s].add[SEGMENT*(s-w)+:SEGMENT] == past_add[w][SEGMENT*s+:SEGMENT]);
      end
      always @(*) if (valid) begin
        assert (segment[s].sum == past_count[s][SEGMENT*s+:SEGMENT]);
      end
    end
  endgenerate
  always @(*) if (valid) begin
    assert (past_add[0] <= QUARTER && !(carry_in && past_add[0] == QUARTER));
    assert (quarter == ref_quarter);  // skewed and plain are the same counter, SEGMENTS - 1 clocks apart
    for (i = 0; i < SEGMENTS; i = i + 1) assert (backs[SEGMENTS-1-i] == past_back[i]);
    assert ({ref_turn[1], ref_turn[1] ^ ref_turn[0]} == ({2{quarter[1] ^ inverted}} ^ (turned ? {quarter[0], 1'b0} : {1'b0, quarter[0]})));
    if (all_forward) assert (!turned && !inverted);
    if (all_back) assert (!inverted && (turned || quarter == 2'd0));
    if (!past_clear) begin
      assert (a == past_turn[1] && b == (past_turn[1] ^ past_turn[0]));
      if (past_forward) assert (a == past_quarter[1] && b == (past_quarter[1] ^ past_quarter[0]));
      if (past_backward) assert (b == past_quarter[1] && a == (past_quarter[1] ^ past_quarter[0]));  // exchanged
      assert (!((a != past_a) && (b != past_b)));  // A and B never move together
    end
  end
`endif
endmodule
`default_nettype wire
