// Increment schedule: spins an axis up and down by a list of (increment, clocks) without a gap between them.
//
// While `run` is high, segments are taken in order: load_increment and increment for one clock, then the next segment's
// exactly `clocks` clocks later (0 acts as 1). The last increment stays in force. A push into a full list is dropped and
// sets `overflow`, sticky until flush. Latency: load_increment is a flip-flop, one clock after the segment is due.
// Reset and flush: empty.
`default_nettype none
module increment_schedule #(
    parameter BITS = 32,
    parameter W = 32,
    parameter ADDRESS_BITS = 4
) (
    input wire clk,
    input wire rst,
    input wire flush,
    input wire run,
    input wire push,
    input wire [BITS-1:0] push_increment,
    input wire [W-1:0] push_clocks,
    output reg load_increment,
    output reg [BITS-1:0] increment,
    output reg busy,
    output wire full,
    output reg overflow
);
  localparam A = ADDRESS_BITS;
  reg [BITS+W-1:0] segments[0:(1<<A)-1];
  reg [A:0] written, taken;
  reg [W-1:0] left;  // clocks until the next segment is due

  wire [A:0] used = written - taken;
  assign full = used[A];
  wire due = run && left <= 1;
  wire next = due && used != 0;
  wire [BITS+W-1:0] segment = segments[taken[A-1:0]];

  always @(posedge clk) begin
    if (push && !full && !rst && !flush) segments[written[A-1:0]] <= {push_increment, push_clocks};
    if (next) increment <= segment[BITS+W-1:W];
    if (rst || flush) begin
      written <= 0;
      taken <= 0;
      left <= 0;
      load_increment <= 1'b0;
      busy <= 1'b0;
      overflow <= 1'b0;
      increment <= 0;
    end else begin
      if (push && !full) written <= written + 1'b1;
      if (push && full) overflow <= 1'b1;
      load_increment <= next;
      if (next) begin
        taken <= taken + 1'b1;
        left <= segment[W-1:0];
      end else if (run && left != 0) left <= left - 1'b1;
      busy <= next || (busy && !due);
    end
  end

`ifdef FORMAL
  // From one load to the next never fewer clocks than the segment asked for.
  reg valid = 1'b0;
  reg [W-1:0] since, asked;
  reg loaded = 1'b0;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    if (rst || flush) loaded <= 1'b0;
    else if (next) begin
      loaded <= 1'b1;
      asked <= segment[W-1:0];
      since <= 0;
    end else if (run && left != 0) since <= since + 1'b1;
  end
  always @(*) if (valid) begin
    assert (used <= (1 << A));
    if (loaded) assert (since + left == asked && since <= asked);
  end
`endif
endmodule
`default_nettype wire
