// Frame parser: bytes from the host -> verified lines.
//
// A frame is the mark 0xA5, "GRV", its kind (1: a line), sequence, revolution, line, first slot and length (32 bits each,
// little endian), the window's packed bits (`length` bytes), and the CRC-32C of all that but the mark. Sequence counts the
// frames since position_load or reset. Payload goes to the FIFO on trial; a frame that is in sequence, in shape and
// whole is committed, any other is rolled back and stops the parser: it takes no byte until clear. Faults are sticky
// until clear; of several in one frame the first of sequence, shape, checksum is reported.
// `odd` belongs to the line committed last: its number, counted from the job's first line, is odd.
// position_load sets the line that must come next (after clear, before a job), as frame 0.
// Latency: commit or fault VERDICT_LATENCY after the frame's last byte; line_valid on the same clock as
// commit. window_slots is to stand for two clocks before a frame and to its end, the other settings and the position for
// two clocks before its last byte.
// Reset: waiting for frame 0, revolution 0, line 0.
`default_nettype none
module frame_parser (
    input wire clk,
    input wire rst,
    input wire clear,
    input wire in_valid,
    input wire [7:0] in_data,
    input wire [23:0] slots_per_line,
    input wire [23:0] window_slots,
    input wire [31:0] lines_per_revolution,
    input wire position_load,
    input wire [31:0] position_revolution,
    input wire [31:0] position_line,
    output reg push,
    output reg [7:0] push_data,
    output reg commit,
    output reg rollback,
    output reg line_valid,
    output reg [23:0] first_slot,
    output reg odd,
    output reg sequence_error,
    output reg shape_error,
    output reg checksum_error,
    output reg [31:0] revolution,
    output reg [31:0] line
);
  localparam [7:0] MARK = 8'hA5;
  localparam [31:0] KIND = 32'h01_56_52_47;  // "GRV", a line
  localparam [1:0] IDLE = 2'd0, HEAD = 2'd1, BITS = 2'd2, CHECK = 2'd3;

  reg [1:0] state;
  reg [20:0] place;  // byte within the part
  reg bad_sequence, bad_shape, bad_checksum;
  reg [23:0] new_first_slot;
  reg [31:0] sequence_number;

  wire stopped = sequence_error || shape_error || checksum_error;
  reg ended;  // the last byte was taken on the clock before; the next frame may begin already
  reg window_fits, last_line;
  reg [24:0] window_end;
  reg [31:0] next_line;
  wire bad = bad_sequence || bad_shape || bad_checksum || !window_fits;
  reg byte_valid;
  reg [7:0] byte_data;
  always @(posedge clk) begin
    byte_valid <= in_valid && !rst && !clear;
    byte_data <= in_data;
  end
  wire take = byte_valid && !stopped && !(ended && bad);
  reg [20:0] window_bytes, last_place;
  wire [7:0] unused_bits = window_slots[2:0] == 0 ? 8'h00 : 8'hFF >> window_slots[2:0];
`ifdef FORMAL
  (* anyseq *) reg [31:0] crc;  // the claims hold whatever the checksum is
`else
  wire [31:0] crc;
  crc32c checksum (
      .clk(clk), .rst(rst), .start(byte_valid && state == IDLE),
      .valid(byte_valid && (state == HEAD || state == BITS)), .data(byte_data), .crc(crc)
  );
`endif

  wire [127:0] expected = {line, revolution, sequence_number, KIND};
  wire [31:0] expected_length = {11'd0, window_bytes};
  // Head bytes are compared a clock late: their verdict is not asked for before the checksum is through.
  reg compare;
  reg [4:0] head_place;
  reg [7:0] head_byte;
  wire wrong = compare && head_byte != expected[8*head_place[3:0]+:8];
  wire wrong_length = compare && head_byte != expected_length[8*head_place[1:0]+:8];
  wire wrong_crc = byte_data != crc[8*place[1:0]+:8];
  wire frame_end = take && state == CHECK && place == 3;

  always @(posedge clk) begin
    window_bytes <= window_slots[23:3] + {20'd0, window_slots[2:0] != 0};
    last_place <= window_bytes - 21'd1;
    window_end <= {1'b0, new_first_slot} + {1'b0, window_slots};
    window_fits <= window_end <= {1'b0, slots_per_line};
    next_line <= line + 32'd1;
    last_line <= next_line >= lines_per_revolution;
    ended <= frame_end && !rst && !clear;
    compare <= take && state == HEAD && !rst && !clear;
    head_place <= place[4:0];
    head_byte <= byte_data;
  end

  always @(posedge clk) begin
    push <= 1'b0;
    commit <= 1'b0;
    rollback <= 1'b0;
    line_valid <= 1'b0;
    if (rst || clear) begin
      state <= IDLE;
      place <= 0;
      bad_sequence <= 1'b0;
      bad_shape <= 1'b0;
      bad_checksum <= 1'b0;
      sequence_error <= 1'b0;
      shape_error <= 1'b0;
      checksum_error <= 1'b0;
      rollback <= 1'b1;
      new_first_slot <= 0;
      if (rst) begin
        push_data <= 0;
        first_slot <= 0;
        odd <= 1'b0;
        revolution <= 0;
        line <= 0;
        sequence_number <= 0;
      end
    end else begin
      if (head_place[4:2] == 3'd0 && wrong) bad_shape <= 1'b1;
      if (!head_place[4] && head_place[3:2] != 2'd0 && wrong) bad_sequence <= 1'b1;
      if (head_place[4] && head_place[2] && wrong_length) bad_shape <= 1'b1;
      if (ended) begin
        commit <= !bad;
        line_valid <= !bad;
        rollback <= bad;
        sequence_error <= bad_sequence;
        shape_error <= !bad_sequence && (bad_shape || !window_fits);
        checksum_error <= !bad_sequence && !bad_shape && window_fits && bad_checksum;
        if (!bad) begin
          first_slot <= new_first_slot;
          sequence_number <= sequence_number + 32'd1;
          odd <= (revolution[0] && lines_per_revolution[0]) ^ line[0];
          line <= last_line ? 32'd0 : next_line;
          if (last_line) revolution <= revolution + 32'd1;
        end
      end
      if (take) begin
        place <= place + 21'd1;
        case (state)
          IDLE: begin
            place <= 0;
            bad_sequence <= 1'b0;
            bad_shape <= 1'b0;
            bad_checksum <= 1'b0;
            if (byte_data == MARK) state <= HEAD;
            else shape_error <= 1'b1;
          end
          HEAD: begin
            if (place == 16) new_first_slot[7:0] <= byte_data;
            if (place == 17) new_first_slot[15:8] <= byte_data;
            if (place == 18) new_first_slot[23:16] <= byte_data;
            if (place == 19 && byte_data != 0) bad_shape <= 1'b1;
            if (place == 23) begin
              place <= 0;
              state <= window_slots == 0 ? CHECK : BITS;
            end
          end
          BITS: begin
            push <= 1'b1;
            push_data <= byte_data;
            if (place == last_place) begin
              if ((byte_data & unused_bits) != 0) bad_shape <= 1'b1;
              place <= 0;
              state <= CHECK;
            end
          end
          CHECK: begin
            if (wrong_crc) bad_checksum <= 1'b1;
            if (frame_end) state <= IDLE;
          end
        endcase
      end
    end
    if (position_load && !rst) begin
      revolution <= position_revolution;
      line <= position_line;
      sequence_number <= 0;
    end
  end

`ifdef FORMAL
  reg valid = 1'b0;
  reg was_bad, was_ended, was_stopped, was_wrong_crc, crc_was_wrong;
  initial assume (rst);
  always @(posedge clk) begin
    valid <= 1'b1;
    was_ended <= ended && !rst && !clear;
    was_bad <= bad;
    was_stopped <= stopped;
    crc_was_wrong <= take && state == CHECK && (wrong_crc || (place != 0 && crc_was_wrong)) || (!take && crc_was_wrong);
    was_wrong_crc <= crc_was_wrong;
  end
  always @(*) if (valid) begin
    if (commit) assert (was_ended && !was_bad && !was_wrong_crc && !was_stopped);  // a bad frame never reaches the gate
    assert (commit == line_valid);
    assert (!(commit && rollback));
    assert (!(commit && push));
    if (was_ended && was_bad) assert (stopped && rollback);
  end
`endif
endmodule
`default_nettype wire
