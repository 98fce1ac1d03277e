#include "ordered_writer.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "dice.hpp"
#include "memory_program.hpp"

namespace gravure {
namespace {

using test::Dice;
using test::MemoryProgram;
using test::MemorySink;

StoredChunk chunk_of(std::int64_t ticket, std::int64_t number, std::size_t bytes) {
  StoredChunk chunk;
  chunk.address = {ticket, number};
  chunk.bytes.resize(bytes);
  return chunk;
}

using Order = std::vector<std::pair<std::int64_t, std::int64_t>>;

TEST(OrderedWriter, WritesInTheOrderOfTicketsWhateverComesFirst) {
  MemoryProgram program;
  MemorySink sink(program);
  OrderedWriter writer(sink, 100);
  EXPECT_TRUE(writer.put(2, chunk_of(2, 0, 10)));
  EXPECT_TRUE(writer.put(1, chunk_of(1, 0, 10)));
  EXPECT_TRUE(writer.close(2));
  EXPECT_TRUE(program.order.empty());
  EXPECT_TRUE(writer.put(0, chunk_of(0, 0, 10)));
  EXPECT_TRUE(writer.put(0, chunk_of(0, 1, 10)));
  EXPECT_TRUE(writer.close(0));
  EXPECT_EQ(program.order, (Order{{0, 0}, {0, 1}, {1, 0}}));
  EXPECT_TRUE(writer.put(1, chunk_of(1, 1, 10)));
  EXPECT_TRUE(writer.close(1));
  EXPECT_EQ(program.order, (Order{{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}}));
  EXPECT_FALSE(writer.error());
}

TEST(OrderedWriter, PassesOverTicketsWithoutChunks) {
  MemoryProgram program;
  MemorySink sink(program);
  OrderedWriter writer(sink, 100);
  EXPECT_TRUE(writer.close(1));
  EXPECT_TRUE(writer.put(2, chunk_of(2, 0, 1)));
  EXPECT_TRUE(writer.close(0));
  EXPECT_EQ(program.order, (Order{{2, 0}}));
}

TEST(OrderedWriter, KeepsTheFirstErrorAndTakesNothingMore) {
  MemoryProgram program;
  MemorySink sink(program);
  sink.fail_at_put = 1;
  OrderedWriter writer(sink, 100);
  EXPECT_TRUE(writer.put(0, chunk_of(0, 0, 1)));
  EXPECT_FALSE(writer.put(0, chunk_of(0, 1, 1)));
  writer.fail({ErrorCode::cancelled, "later"});
  EXPECT_FALSE(writer.put(0, chunk_of(0, 2, 1)));
  EXPECT_FALSE(writer.put(7, chunk_of(7, 0, 1)));
  EXPECT_FALSE(writer.close(0));
  ASSERT_TRUE(writer.error());
  EXPECT_EQ(writer.error()->message, "the disk is full here");
  EXPECT_EQ(program.order, (Order{{0, 0}}));
}

TEST(OrderedWriter, StopsAfterAnErrorAmongWhatWasWaiting) {
  MemoryProgram program;
  MemorySink sink(program);
  sink.fail_at_put = 0;
  OrderedWriter writer(sink, 100);
  EXPECT_TRUE(writer.put(1, chunk_of(1, 0, 1)));
  EXPECT_TRUE(writer.put(1, chunk_of(1, 1, 1)));
  EXPECT_FALSE(writer.close(0));
  EXPECT_TRUE(program.order.empty());
}

/// Workers take tickets as those of the compiler do; sizes and gaps are random.
void run_stress(int workers, std::int64_t tickets, OrderedWriter& writer) {
  std::atomic<std::int64_t> next{0};
  std::vector<std::thread> threads;
  for (int worker = 0; worker < workers; ++worker) {
    threads.emplace_back([&] {
      for (std::int64_t ticket = next++; ticket < tickets; ticket = next++) {
        Dice dice(static_cast<std::uint64_t>(ticket));
        for (std::int64_t number = 0; number < ticket % 4; ++number) {
          for (std::int64_t spin = dice.between(0, 3); spin > 0; --spin) {
            std::this_thread::yield();
          }
          if (!writer.put(ticket, chunk_of(ticket, number, static_cast<std::size_t>(dice.between(0, 50))))) {
            return;
          }
        }
        if (!writer.close(ticket)) {
          return;
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
}

TEST(OrderedWriter, NeitherStallsNorReordersUnderStress) {
  SCOPED_TRACE(Dice::note());
  for (const std::int64_t ahead : {0, 1, 40, 1'000'000}) {
    for (const int workers : {1, 2, 7}) {
      MemoryProgram program;
      MemorySink sink(program);
      OrderedWriter writer(sink, ahead);
      constexpr std::int64_t kTickets = 2000;
      run_stress(workers, kTickets, writer);
      Order expected;
      for (std::int64_t ticket = 0; ticket < kTickets; ++ticket) {
        for (std::int64_t number = 0; number < ticket % 4; ++number) {
          expected.emplace_back(ticket, number);
        }
      }
      EXPECT_EQ(program.order, expected) << ahead << " bytes ahead, " << workers << " workers";
      EXPECT_FALSE(writer.error());
      EXPECT_FALSE(sink.put_at_once_by_two);
    }
  }
}

TEST(OrderedWriter, LetsEveryWorkerGoWhenOneFails) {
  SCOPED_TRACE(Dice::note());
  for (const std::int64_t at : {0, 1, 500, 1400}) {
    MemoryProgram program;
    MemorySink sink(program);
    sink.fail_at_put = at;
    OrderedWriter writer(sink, 10);
    run_stress(7, 1000, writer);
    ASSERT_TRUE(writer.error());
    EXPECT_EQ(static_cast<std::int64_t>(program.order.size()), at);
  }
}

}  // namespace
}  // namespace gravure
