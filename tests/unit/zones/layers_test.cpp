#include "gravure/zones/layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "dice.hpp"

namespace gravure::zones {
namespace {

TEST(LayerStack, IsThePublishedOneWithoutItsEmptyLayer) {
  const LayerStack stack = layer_stack(0, 0.9, 0.3).value();
  EXPECT_EQ(stack.count, 3U);
  const double heights[] = {0, .1, .29, .31, .62, .9};
  const std::size_t layers[] = {2, 2, 2, 1, 0, 0};
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(stack.layer_of(heights[i]), layers[i]) << heights[i];
  }
  EXPECT_NEAR(stack.centre_mm(0), .75, 1e-15);
  EXPECT_NEAR(stack.centre_mm(1), .45, 1e-15);
  EXPECT_NEAR(stack.centre_mm(2), .15, 1e-15);
}

TEST(LayerStack, HasNoEmptyLayerAtMultiples) {
  const auto literal = [](double height) { return std::floor(height / 0.3 + 1e-12) + 1; };  // [D] eq. 14
  const double heights[] = {0.3, 0.6, 0.9};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(layer_stack(0, heights[i], 0.3).value().count, static_cast<std::size_t>(i + 1));
    EXPECT_EQ(literal(heights[i]), i + 2);
  }
  EXPECT_EQ(layer_stack(5, 5, 0.3).value().count, 1U);
  EXPECT_EQ(layer_stack(0, 0.31, 0.3).value().count, 2U);
}

TEST(LayerStack, IsCentred) {
  const LayerStack stack = layer_stack(-0.2, 0.5, 0.3).value();
  EXPECT_EQ(stack.count, 3U);
  EXPECT_NEAR(stack.thickness_mm, 0.7 / 3, 1e-15);
  EXPECT_NEAR(stack.centre_mm(1), 0.15, 1e-15);
}

TEST(LayerStack, RefusesWhatIsNoThickness) {
  EXPECT_EQ(layer_stack(0, 1, 0).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(layer_stack(0, 1, std::nan("")).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(layer_stack(0, 1e6, 1e-3).error().code, ErrorCode::out_of_range);
  const auto nowhere = layer_stack(0, std::nan(""), 1);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().message, "heights from 0 to nan mm: must be numbers, the lower one first");
}

TEST(CutLayers, LosesNothingAndDoublesNothing) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(51);
  const auto number = [&dice] { return static_cast<double>(dice.between(-1'000'000, 1'000'000)) / 1'000'000; };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Piece> pieces(3);
    double least = 1e9;
    double top = -1e9;
    const LocalFrame frame = local_frame({number(), number(), number() + 2}, {number(), number(), number()}).value();
    for (Piece& piece : pieces) {
      piece.points_mm.resize(static_cast<std::size_t>(dice.between(2, 12)));
      for (Vector3& point : piece.points_mm) {
        point = {number(), number(), number()};
        least = std::min(least, frame.to_local(point).z());
        top = std::max(top, frame.to_local(point).z());
      }
    }
    const LayerStack stack = layer_stack(least, top, trial % 2 == 0 ? 0.07 : 0.5).value();
    const std::vector<Stroke> strokes = cut_layers(pieces, {0, 1, 2}, frame, stack);
    std::map<std::size_t, std::vector<const Stroke*>> of_piece;
    for (const Stroke& stroke : strokes) {
      of_piece[stroke.piece].push_back(&stroke);
      ASSERT_GE(stroke.points_mm.size(), 2U);
      for (const Vector3& point : stroke.points_mm) {
        ASSERT_LE(std::abs(point.z() - stack.centre_mm(stroke.layer)), stack.thickness_mm / 2 + 1e-12);
      }
    }
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      double length = 0;
      for (std::size_t s = 0; s < of_piece[p].size(); ++s) {
        length += length_mm(of_piece[p][s]->points_mm);
        if (s > 0) {  // they hang together, to the bit
          ASSERT_EQ(of_piece[p][s]->points_mm.front(), of_piece[p][s - 1]->points_mm.back());
          ASSERT_NE(of_piece[p][s]->layer, of_piece[p][s - 1]->layer);
        }
      }
      ASSERT_NEAR(length, length_mm(pieces[p].points_mm), 1e-12 * static_cast<double>(strokes.size() + 10));
      ASSERT_EQ(of_piece[p].front()->points_mm.front(), frame.to_local(pieces[p].points_mm.front()));
      ASSERT_EQ(of_piece[p].back()->points_mm.back(), frame.to_local(pieces[p].points_mm.back()));
    }
  }
}

TEST(CutLayers, CutsOnThePlanesAndPutsWhatLiesInOneBelowIt) {
  std::vector<Piece> pieces(1);
  pieces[0].points_mm = {{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {2, 0, -1}};
  const LocalFrame frame;
  const LayerStack stack = layer_stack(-1, 1, 1).value();
  const std::vector<Stroke> strokes = cut_layers(pieces, {0}, frame, stack);
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[0].layer, 0U);
  EXPECT_EQ(strokes[0].points_mm, (std::vector<Vector3>{{0, 0, 1}, {0, 0, 0}}));
  EXPECT_EQ(strokes[1].layer, 1U);
  EXPECT_EQ(strokes[1].points_mm, (std::vector<Vector3>{{0, 0, 0}, {1, 0, 0}, {2, 0, -1}}));
  pieces[0].points_mm = {{0, 0, -1}, {4, 0, 1}};
  const std::vector<Stroke> up = cut_layers(pieces, {0}, frame, layer_stack(-1, 1, 0.5).value());
  ASSERT_EQ(up.size(), 4U);
  EXPECT_EQ(up[0].layer, 3U);
  EXPECT_EQ(up[1].points_mm, (std::vector<Vector3>{{1, 0, -0.5}, {2, 0, 0}}));
}

TEST(CutToField, KeepsLengthAndFitsTheField) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(52);
  const auto number = [&dice] { return static_cast<double>(dice.between(-50'000, 50'000)) / 1000; };
  for (int trial = 0; trial < 100; ++trial) {
    Contour contour;
    contour.id = 1;
    for (int i = 0; i < 8; ++i) {
      contour.points_mm.push_back({number(), number(), number()});
    }
    contour.direction = {0.6, 0, 0.8};
    const double field = 3 + trial % 10;
    const std::vector<Piece> pieces = cut_to_field({contour}, field).value();
    ASSERT_GT(pieces.size(), 3U);
    const LocalFrame frame = local_frame(pieces[0].direction, Vector3::Zero()).value();
    double length = 0;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      ASSERT_EQ(pieces[p].part, p);
      ASSERT_GE(pieces[p].points_mm.size(), 2U);
      length += length_mm(pieces[p].points_mm);
      for (int axis = 0; axis < 2; ++axis) {
        double least = 1e9;
        double most = -1e9;
        for (const Vector3& point : pieces[p].points_mm) {
          least = std::min(least, frame.to_local(point)[axis]);
          most = std::max(most, frame.to_local(point)[axis]);
        }
        ASSERT_LE(most - least, field + 1e-9);
      }
      if (p > 0) {
        ASSERT_EQ(pieces[p].points_mm.front(), pieces[p - 1].points_mm.back());
      }
    }
    std::vector<Vector3> whole;
    for (const auto& point : contour.points_mm) {
      whole.push_back({point[0], point[1], point[2]});
    }
    ASSERT_NEAR(length, length_mm(whole), 1e-9);
  }
}

TEST(CutToField, CutsEvenly) {
  Contour contour;
  contour.points_mm = {{0, 0, 0}, {3, 0, 0}, {4.004, 0, 0}};
  std::vector<Piece> pieces = cut_to_field({contour}, 2).value();
  ASSERT_EQ(pieces.size(), 3U);
  for (const Piece& piece : pieces) {
    EXPECT_NEAR(length_mm(piece.points_mm), 4.004 / 3, 1e-12);
  }
  // Back and forth, then on: thirds of its length do not fit, and a cut where it leaves the field leaves 4 um.
  contour.points_mm = {{0, 0, 0}, {0, 2, 0}, {0, 0, 0}, {0, 2, 0}, {0, 0, 0}, {4.004, 0, 0}};
  pieces = cut_to_field({contour}, 2).value();
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(length_mm(pieces[0].points_mm), 8.004, 1e-12);
  EXPECT_NEAR(length_mm(pieces[1].points_mm), 2, 1e-12);
  EXPECT_NEAR(length_mm(pieces[2].points_mm), 2, 1e-12);
}

TEST(CutToField, LeavesContoursThatFit) {
  Contour contour;
  contour.id = 3;
  contour.points_mm = {{0, 0, 0}, {10, 0, 0}};
  EXPECT_EQ(cut_to_field({contour}, 10).value().size(), 1U);
  EXPECT_EQ(cut_to_field({contour}, 9.99).value().size(), 2U);
  EXPECT_EQ(cut_to_field({contour}, 0).error().code, ErrorCode::out_of_range);
  contour.points_mm.pop_back();
  EXPECT_EQ(cut_to_field({contour}, 1).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace gravure::zones
