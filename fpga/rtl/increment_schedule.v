// Increment schedule: spins an axis up and down by a list of (increment, clocks) without a gap between them.
//
// While `run` is high, segments are taken in order: load_increment and increment for one clock, then the next segment's
// exactly `clocks` clocks later (0 acts as 1). The last increment stays in force. A push into a full list is dropped and
// sets `overflow`, sticky until flush. The list is a line_fifo, so it maps to block RAM.
// Latency: load_increment is a flip-flop, SCHEDULE_LATENCY after the segment is due; a segment can be due
// three clocks after its push at the earliest. Reset and flush: empty, increment 0.
`default_nettype none
module increment_schedule #(
    parameter BITS = 32,
    parameter W = 32,
    parameter ADDRESS_BITS = 8
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
    output wire overflow
);
  reg [W-1:0] left;  // clocks until the next segment is due
  wire segment_valid;
  wire [BITS+W-1:0] segment;
  reg over;             // left is 1 or less
  wire due = run && over;
  wire next = due && segment_valid;
  /* verilator lint_off PINCONNECTEMPTY */
  line_fifo #(.W(BITS + W), .ADDRESS_BITS(ADDRESS_BITS)) segments (
      .clk(clk), .rst(rst), .flush(flush), .push(push), .push_data({push_increment, push_clocks}), .commit(1'b1),
      .rollback(1'b0), .pop(next), .low_level({(ADDRESS_BITS + 2) {1'b0}}), .valid(segment_valid), .data(segment),
      .level(), .almost_empty(), .full(full), .overflow(overflow)
  );
  /* verilator lint_on PINCONNECTEMPTY */

  always @(posedge clk) begin
    if (rst || flush) begin
      left <= 0;
      over <= 1'b1;
      load_increment <= 1'b0;
      busy <= 1'b0;
      increment <= 0;
    end else begin
      load_increment <= next;
      if (next) begin
        increment <= segment[BITS+W-1:W];
        left <= segment[W-1:0];
        over <= segment[W-1:1] == 0;
      end else if (run && left != 0) begin
        left <= left - 1'b1;
        over <= left[W-1:2] == 0 && left[1:0] != 2'd3;
      end
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
    assert (over == (left <= 1));
    if (loaded) assert (since + left == asked && since <= asked);
  end
`endif
endmodule
`default_nettype wire
