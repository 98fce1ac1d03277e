// Line FIFO: bytes of frames on trial until their checksum is known; only committed bytes are ever read.
//
// push writes on trial; commit makes all that was pushed before this clock readable; rollback forgets what is not
// committed (and a push on the same clock). `data` is shown while `valid`; pop takes it. level counts committed bytes
// that were not yet popped, almost_empty says that they are `low_level` or fewer. A push without room is dropped and sets `overflow`, sticky until flush or reset.
// Latency: a committed byte is valid two clocks after the commit at the earliest; level shows LEVEL_LATENCY after what
// it counts, almost_empty ALMOST_EMPTY_LATENCY. Memory: one write and one registered
// read port, so it maps to block RAM. Reset and flush: empty.
`default_nettype none
module line_fifo #(
    parameter W = 8,
    parameter ADDRESS_BITS = 12
) (
    input wire clk,
    input wire rst,
    input wire flush,
    input wire push,
    input wire [W-1:0] push_data,
    input wire commit,
    input wire rollback,
    input wire pop,
    input wire [ADDRESS_BITS+1:0] low_level,
    output reg valid,
    output reg [W-1:0] data,
    output reg [ADDRESS_BITS+1:0] level,
    output reg almost_empty,
    output wire full,
    output reg overflow
);
  localparam A = ADDRESS_BITS;
  (* no_rw_check *) reg [W-1:0] memory[0:(1<<A)-1];  // never read where it is written on the same clock: proved below
  reg [A:0] written;    // pushed, on trial or not
  reg [A:0] committed;
  reg [A:0] taken;      // moved to `data`

  wire [A:0] ready = committed - taken;
  wire any_ready = committed != taken;
  assign full = written == (taken ^ {1'b1, {A{1'b0}}});
  wire accept = push && !full && !rollback && !flush && !rst;
  wire refill = (!valid || pop) && any_ready;

  always @(posedge clk) begin
    if (accept) memory[written[A-1:0]] <= push_data;
    if (refill) data <= memory[taken[A-1:0]];
  end

  always @(posedge clk) begin
    almost_empty <= level <= low_level;
    if (rst || flush) level <= 0;
    else level <= {1'b0, ready} + {{(A + 1) {1'b0}}, valid};
    if (rst || flush) begin
      written <= 0;
      committed <= 0;
      taken <= 0;
      valid <= 1'b0;
      overflow <= 1'b0;
    end else begin
      if (rollback) written <= committed;
      else if (accept) written <= written + 1'b1;
      if (commit && !rollback) committed <= written;
      if (refill) begin
        taken <= taken + 1'b1;
        valid <= 1'b1;
      end else if (pop) valid <= 1'b0;
      if (push && full && !rollback) overflow <= 1'b1;
    end
  end

`ifdef FORMAL
  // One place of the stream, chosen once for all: what is pushed there is what is read there, neither lost nor doubled.
  (* anyconst *) reg [A:0] place;
  reg [W-1:0] pushed;
  reg shown = 1'b0;  // `data` is the byte of `place`
  reg past_valid = 1'b0;
  initial assume (rst);
  wire [A:0] from_taken = place - taken;
  wire [A:0] used = written - taken;
  always @(posedge clk) begin
    past_valid <= 1'b1;
    if (accept && written == place) pushed <= push_data;
    if (rst || flush) shown <= 1'b0;
    else if (refill) shown <= taken == place;
    else if (pop) shown <= 1'b0;
  end
  reg [W-1:0] shown_byte;
  always @(posedge clk) if (refill && taken == place) shown_byte <= pushed;
  always @(*) if (past_valid) begin
    assert (used <= (1 << A));
    assert (committed - taken <= used);
    if (accept && refill) assert (written[A-1:0] != taken[A-1:0]);
    if (from_taken < used) assert (memory[place[A-1:0]] == pushed);
    if (shown && valid) assert (data == shown_byte);
  end
`endif
endmodule
`default_nettype wire
