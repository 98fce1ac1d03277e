// Line progress: how far the lines that came in frames have been carried out, for a host that goes on after a fault.
//
// A slot has passed when the gate let its decision through (`passed`), in the window or not, its bit 1 or 0, and however soon
// the gate closed after that: a pulse may have fired. So the slots of a line that have passed are its first ones; to send the
// line again without their bits neither loses a pulse nor repeats one.
// executed: lines whose slots have all passed since load, counted when the last one is over: by the next slot, or because
// the gate closed in it. slots: those of the line that runs that have passed, 0 outside of lines. partial: the gate closed
// in the midst of a line, by a fault or a stop, with `slots` of it passed; nothing counts from there until clear or load.
// A line that began without a frame, while a fault stood, or before the last clear or load does not count.
// `begins` and `queued` come with the sequencer's first slot of a line, which the gate sees a clock later at the earliest.
// Latency: PROGRESS_LATENCY behind the gate. Reset: nothing has passed.
`default_nettype none
module line_progress #(
    parameter W = 24,
    parameter LINE_BITS = 32
) (
    input wire clk,
    input wire rst,
    input wire clear,
    input wire load,
    input wire run,
    input wire begins,
    input wire queued,
    input wire slot,
    input wire passed,
    input wire open,
    input wire dark,
    output reg [LINE_BITS-1:0] executed,
    output reg [W-1:0] slots,
    output reg partial
);
  reg next_framed, framed;  // the line that the sequencer began last, and the one of `passed`
  reg midway;               // some slots of a line have passed, and not its last
  reg ending;               // the last slot has, and may still be on
  reg was_slot;
  wire forget = rst || clear || load;
  wire counts = passed && framed && !partial;
  wire ends = counts && !open;
  wire over = ending && (was_slot || dark || !run);

  always @(posedge clk) begin
    was_slot <= slot;
    next_framed <= !forget && (begins ? queued : next_framed);
    framed <= !forget && next_framed;
    midway <= !forget && (counts || midway) && open;
    partial <= !forget && (partial || (midway && !open && !passed));
    ending <= !rst && !load && (ends || (ending && !over));
    if (forget || ends) slots <= 0;
    else if (counts) slots <= slots + 1'b1;
    if (rst || load) executed <= 0;
    else if (over) executed <= executed + 1'b1;
  end

`ifdef FORMAL
  // What the gate promises (pulse_gate.v): a decision passes a clock after its slot, as the first of a line where the gate
  // was not open for one, and leaves it open unless it was the last; nothing else opens it. And the delay (direction_delay.v):
  // when the sequencer begins a line the last decision of the one before is at the gate at the latest.
  reg valid = 1'b0;
  reg was_open, has_begun;
  wire first = passed && !was_open;
  initial assume (rst);
  always @(*) begin
    if (passed) assume (was_slot);
    if (open) assume (passed || was_open);
    if (has_begun) assume (!open);
  end
  always @(posedge clk) begin
    valid <= 1'b1;
    was_open <= open && !rst;
    has_begun <= begins;
  end

  // Every line of a frame that began to pass is executed, on its way, or the one that was cut; never two of these.
  reg [LINE_BITS-1:0] begun;
  reg mine;  // the line that runs has a frame and began after the last clear or load
  reg [W-1:0] count;
  wire mine_now = first ? framed && !partial : mine;
  reg was_partial, was_forgotten, was_cleared;
  reg [LINE_BITS-1:0] past_executed;
  reg [W-1:0] past_slots;
  always @(posedge clk) begin
    if (rst || load) begun <= 0;
    else if (clear) begun <= executed + ending + ends;  // what ran is given up
    else if (first && mine_now) begun <= begun + 1'b1;
    mine <= !forget && (passed ? mine_now : mine);
    if (passed && mine_now) count <= first ? {{(W - 1) {1'b0}}, 1'b1} : count + 1'b1;
    was_partial <= partial;
    was_forgotten <= forget;
    was_cleared <= rst || load;
    past_executed <= executed;
    past_slots <= slots;
  end
  always @(*) if (valid) begin
    assert (begun == executed + ending + midway + partial);
    assert (!(midway && partial) && !(ending && partial));
    if (midway || partial) assert (slots == count);
    if (!midway && !partial) assert (slots == 0);
    if (was_partial && !was_forgotten) assert (partial && slots == past_slots && executed == past_executed);
    if (!was_cleared) assert (executed == past_executed || executed == past_executed + 1'b1);
  end
`endif
endmodule
`default_nettype wire
