// Watchdog: expires when the host is silent for `limit` clocks; sticky until clear.
//
// kick is any sign of life. enable low holds it at rest; expired then stays as it is. A limit of 0 expires at once.
// Latency: WATCHDOG_LATENCY. Reset: not expired.
`default_nettype none
module watchdog #(
    parameter W = 32
) (
    input wire clk,
    input wire rst,
    input wire enable,
    input wire kick,
    input wire clear,
    input wire [W-1:0] limit,
    output reg expired
);
  reg [W-1:0] silent;

  always @(posedge clk) begin
    if (rst || clear) begin
      silent <= 0;
      expired <= 1'b0;
    end else if (!enable || kick) silent <= 0;
    else if (silent >= limit) expired <= 1'b1;
    else silent <= silent + 1'b1;
  end

`ifdef FORMAL
  reg valid = 1'b0;
  reg was_expired, was_cleared;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    was_expired <= expired;
    was_cleared <= rst || clear;
  end
  always @(*) if (valid && was_expired && !was_cleared) assert (expired);
`endif
endmodule
`default_nettype wire
