// Fault latch: keeps the first fault until it is acknowledged, and which others came after it; the numbers are those of
// DeviceFault on the host, bit n - 1 of `seen` is fault n.
//
// Causes on the same clock: the lowest number is kept. An acknowledge clears the fault, unless a cause is present on the
// same clock. Latency: FAULT_LATENCY. Reset: none.
`default_nettype none
module fault_latch (
    input wire clk,
    input wire rst,
    input wire acknowledge,
    input wire sequence_error,
    input wire checksum_error,
    input wire shape_error,
    input wire underrun,
    input wire host_silence,
    input wire interlock,
    output reg [2:0] fault,
    output reg [5:0] seen,
    output wire any
);
  assign any = fault != 0;
  wire [2:0] cause = sequence_error ? 3'd1 : checksum_error ? 3'd2 : shape_error ? 3'd3 :
                     underrun ? 3'd4 : host_silence ? 3'd5 : interlock ? 3'd6 : 3'd0;
  wire [5:0] causes = {interlock, host_silence, underrun, shape_error, checksum_error, sequence_error};
  always @(posedge clk) begin
    if (rst) seen <= 6'd0;
    else seen <= causes | (acknowledge ? 6'd0 : seen);
    if (rst) fault <= 3'd0;
    else if (acknowledge || !any) fault <= cause;
  end

`ifdef FORMAL
  reg valid = 1'b0;
  reg [2:0] past_fault;
  reg [5:0] past_seen;
  reg released;
  reg had_cause;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    past_fault <= fault;
    past_seen <= seen;
    released <= rst || acknowledge;
    had_cause <= cause != 0 && !rst;
  end
  always @(*) if (valid) begin
    if (past_fault != 0 && !released) assert (fault == past_fault);  // sticky, and the first one
    if (had_cause) assert (any);
    assert (fault != 3'd7);
    assert (any == (seen != 0));
    if (fault != 0) assert (seen[fault - 3'd1]);
    if (!released) assert ((past_seen & ~seen) == 0);  // every one of them
  end
`endif
endmodule
`default_nettype wire
