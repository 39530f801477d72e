#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/errors.hpp"
#include "dem/contacts.hpp"

using namespace edmill;

namespace {

class FrameReaderTest : public testing::Test {
 protected:
  std::string file =
      std::filesystem::temp_directory_path() / ("edmill_frames_" + std::to_string(::getpid()));
  void TearDown() override { std::filesystem::remove(file); }

  void put(const std::string& text) { std::ofstream(file) << text; }
  std::string problem(const std::string& text, const dem::DumpFormat& format = {1e-6, "si"}) {
    put(text);
    try {
      dem::FrameReader reader(file, format, 2);
      for (dem::Frame frame; reader.next(frame);) {
      }
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

constexpr const char* head =
    "ITEM: TIMESTEP\n10\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 2\n0 2\n0 2\n";
constexpr const char* columns = "ITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\n";
constexpr const char* row_1 = "1 0.1 0.2 0.3 1 2 3 4 5 6\n";
constexpr const char* row_2 = "2 0.4 0.5 0.6 7 8 9 10 11 12\n";

TEST_F(FrameReaderTest, ColumnsAndBallsInAnyOrder) {
  put(std::string(head) + "ITEM: ATOMS omegaz type vz vy vx z y x id omegay omegax\n" +
      "12 1 9 8 7 0.6 0.5 0.4 2 11 10\n6 1 3 2 1 0.3 0.2 0.1 1 5 4\n");
  dem::FrameReader reader(file, {1e-6, "si"}, 2);
  dem::Frame frame;
  ASSERT_TRUE(reader.next(frame));
  EXPECT_DOUBLE_EQ(frame.time, 1e-5);
  EXPECT_DOUBLE_EQ(frame.balls[0].position[2], 0.3);
  EXPECT_DOUBLE_EQ(frame.balls[1].velocity[0], 7);
  EXPECT_DOUBLE_EQ(frame.balls[1].spin[2], 12);
  EXPECT_FALSE(reader.next(frame));
}

TEST_F(FrameReaderTest, UnitsTimesAndScaledPlaces) {
  put("ITEM: UNITS\ncgs\nITEM: TIME\n0.5\n" + std::string(head) +
      "ITEM: ATOMS id xs ys zs vx vy vz omegax omegay omegaz mass diameter\n"
      "1 0.5 0 0 100 0 0 2 0 0 3 0.8\n2 0 0.25 0 0 0 0 0 0 0 3 0.8\n");
  dem::FrameReader reader(file, {std::nullopt, "si"}, 2);
  dem::Frame frame;
  ASSERT_TRUE(reader.next(frame));
  EXPECT_DOUBLE_EQ(frame.time, 0.5);
  EXPECT_DOUBLE_EQ(frame.balls[0].position[0], 0.01);
  EXPECT_DOUBLE_EQ(frame.balls[0].velocity[0], 1);
  EXPECT_DOUBLE_EQ(frame.balls[0].spin[0], 2);
  EXPECT_DOUBLE_EQ(reader.masses()[0], 0.003);
  EXPECT_DOUBLE_EQ(reader.radii()[0], 0.004);
}

TEST_F(FrameReaderTest, ATableWhoseRowsOfOneTimeAreAFrame) {
  put("# of another "
      "code\nt;ball;x;y;z;vx;vy;vz;wx;wy;wz\n0.5;7;1;0;0;0;0;0;0;0;0\n0.5;3;2;0;0;0;0;0;0;0;0\n"
      "0.6;3;4;0;0;0;0;0;0;0;0\n0.6;7;3;0;0;0;0;0;0;0;0\n0.7;7;3;0;0;0;0;0;0;0;0\n");
  dem::FrameReader reader(file, {std::nullopt, "si"}, 2);
  dem::Frame frame;
  ASSERT_TRUE(reader.next(frame));
  EXPECT_EQ(frame.time, 0.5);
  EXPECT_EQ(frame.balls[0].position[0], 2);
  ASSERT_TRUE(reader.next(frame));
  EXPECT_EQ(frame.time, 0.6);
  EXPECT_EQ(frame.balls[1].position[0], 3);
  EXPECT_FALSE(reader.next(frame));  // cut off
}

TEST_F(FrameReaderTest, AFileThatIsCutOffEndsBeforeItsLastFrame) {
  const std::string whole = std::string(head) + columns + row_1 + row_2;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::string second = whole;
    second.replace(second.find("10"), 2, "20");
    put(whole + second.substr(0, size));
    dem::FrameReader reader(file, {1e-6, "si"}, 2);
    dem::Frame frame;
    ASSERT_TRUE(reader.next(frame));
    try {
      EXPECT_FALSE(reader.next(frame)) << size;
    } catch (const InputError&) {  // a word cut off is no word
    }
  }
}

TEST_F(FrameReaderTest, BinaryDumpsAreTheTextTheyStandFor) {
  const std::string made = EDMILL_SOURCE_DIR "/tests/judge/dem/two_balls";  // by LAMMPS
  dem::FrameReader text(made + ".dump", {std::nullopt, "si"}, 2),
      binary(made + ".bin", {std::nullopt, "si"}, 2);
  dem::Frame expected, found;
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_TRUE(text.next(expected));
    ASSERT_TRUE(binary.next(found));
    EXPECT_EQ(found.time, expected.time);
    EXPECT_DOUBLE_EQ(found.time, 2e-4 * frame);
    for (std::size_t ball = 0; ball < 2; ++ball) {
      EXPECT_EQ(found.balls[ball].position, expected.balls[ball].position);
      EXPECT_EQ(found.balls[ball].velocity, expected.balls[ball].velocity);
      EXPECT_EQ(found.balls[ball].spin, expected.balls[ball].spin);
    }
  }
  EXPECT_FALSE(text.next(expected));
  EXPECT_FALSE(binary.next(found));
  EXPECT_EQ(binary.masses(), text.masses());
  EXPECT_EQ(binary.radii(), text.radii());
}

TEST_F(FrameReaderTest, ABinaryDumpThatIsCutOffOrDamaged) {
  std::ifstream in(EDMILL_SOURCE_DIR "/tests/judge/dem/two_balls.bin", std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  constexpr std::size_t last_frame = 389;
  for (std::size_t size = whole.size() - last_frame; size < whole.size(); ++size) {
    put(whole.substr(0, size));
    dem::FrameReader reader(file, {std::nullopt, "si"}, 2);
    dem::Frame frame;
    EXPECT_TRUE(reader.next(frame) && reader.next(frame));
    EXPECT_FALSE(reader.next(frame)) << size;
  }
  const auto damaged = [&](std::size_t place, const std::string& bytes) {
    std::string text = whole;
    return problem(text.replace(place, bytes.size(), bytes));
  };
  using namespace std::string_literals;
  EXPECT_EQ(problem(whole), "");
  EXPECT_NE(damaged(0, "\0\0\0\0\0\0\0\0"s).find("does not name its columns"), std::string::npos);
  EXPECT_NE(damaged(8, "X").find("does not name its columns"), std::string::npos);
  EXPECT_NE(damaged(18, "\0\0\0\1"s).find("the byte order of another machine"), std::string::npos);
  EXPECT_NE(damaged(22, "\1"s).find("revision 1"), std::string::npos);
  EXPECT_NE(damaged(34, "\3"s).find("3 balls"), std::string::npos);
  EXPECT_NE(
      damaged(whole.find("omegax"), "ooegax").find("columns without omegax"), std::string::npos);
  EXPECT_NE(damaged(whole.size() - 8, "\xff\xff\xff\xff\xff\xff\xff\xff").find("expected finite"),
      std::string::npos);
}

/// Boxes that LAMMPS has, and numbers as codes write them.
TEST_F(FrameReaderTest, WrappedPlacesAndOtherNumbers) {
  const std::string bounds = "0 2\n0 2\n0 2\n", tilted = "0 2 0.5\n0 2 0\n0 2 0\n";
  const auto place = [&](const std::string& box, const std::string& names,
                         const std::string& values) {
    const std::string rest = " 1 2 3 4 5 6\n";
    std::string text = head;
    text.replace(text.find(bounds), bounds.size(), box);
    put(text + "ITEM: ATOMS id " + names + " vx vy vz omegax omegay omegaz\n" + "1 " + values +
        rest + "2 " + values + rest);
    dem::FrameReader reader(file, {1e-6, "si"}, 2);
    dem::Frame frame;
    EXPECT_TRUE(reader.next(frame));
    return frame.balls[0].position[0];
  };
  EXPECT_DOUBLE_EQ(place(bounds, "x y z ix iy iz", "0.5 0 0 -1 0 0"), -1.5);
  EXPECT_DOUBLE_EQ(place(bounds, "xs ys zs ix iy iz", "0.25 0 0 1 0 0"), 2.5);
  EXPECT_DOUBLE_EQ(place(bounds, "xu yu zu ix iy iz", "2.5 0 0 1 0 0"), 2.5);
  EXPECT_DOUBLE_EQ(place(tilted, "x y z", "0.5 0 0"), 0.5);
  EXPECT_DOUBLE_EQ(place(bounds, "x y z", "+5.0D-01 0 0"), 0.5);
  EXPECT_THROW(place(tilted, "xs ys zs", "0.5 0 0"), InputError);
  EXPECT_THROW(place(tilted, "x y z ix iy iz", "0.5 0 0 1 0 0"), InputError);
}

TEST_F(FrameReaderTest, TheTimeStepOfADeckIsANumberOrIsNotKnown) {
  const auto step_of = [&](const std::string& deck) {
    put(deck);
    const auto facts = dem::facts_of_deck(file);
    EXPECT_EQ(facts.no_time_step.empty(), facts.time_step && *facts.time_step == 2e-6) << deck;
    return facts.no_time_step;
  };
  EXPECT_EQ(step_of("units si\ntimestep 2e-6\nrun 10\ntimestep 0.000002\n"), "");
  EXPECT_EQ(step_of("O.dt = 2e-6\n"), "");
  for (const auto* deck :
      {"variable dt equal 2e-6\ntimestep ${dt}\n", "O.dt = 0.8*PWaveTimeStep()\n",
          "timestep 1e-6\nrun 10\ntimestep 3e-6\n", "timestep 0\n"})
    EXPECT_NE(step_of(deck).find("give --timestep"), std::string::npos) << deck;
}

TEST_F(FrameReaderTest, Problems) {
  const std::string good = std::string(head) + columns + row_1 + row_2;
  EXPECT_EQ(problem(good), "");
  EXPECT_NE(problem(good, {std::nullopt, "si"}).find("without time"), std::string::npos);
  EXPECT_NE(problem(good + good).find("expected one after"), std::string::npos);
  EXPECT_NE(
      problem(std::string(head) + "ITEM: ATOMS id x y z vx vy vz\n1 0 0 0 0 0 0\n").find("omegax"),
      std::string::npos);
  EXPECT_NE(problem("1,2,3\n").find("columns without id"), std::string::npos);
  EXPECT_NE(
      problem("id,x,y,z,vx,vy,vz,wx,wy,wz\n").find("columns without time"), std::string::npos);
  EXPECT_EQ(problem(" \n"), "");
  EXPECT_NE(problem(" \nI\n:M").find("columns without id"), std::string::npos);
  EXPECT_NE(
      problem(std::string(head) + "ITEM: ATOMS\n").find("columns without id"), std::string::npos);
  EXPECT_NE(problem(good + "1 2 3\n").find("ITEM:"), std::string::npos);
  for (const auto* value : {"nan", "inf", "-1e160"})
    EXPECT_NE(
        problem(std::string(head) + columns + "1 0.1 0.2 0.3 1 " + value + " 3 4 5 6\n" + row_2)
            .find("the code has become unstable"),
        std::string::npos);
  EXPECT_NE(problem(std::string(head) + columns + row_1 + row_1).find("twice"), std::string::npos);
  EXPECT_NE(problem("ITEM: UNITS\nlj\n" + good).find("units 'lj'"), std::string::npos);
  std::string three = good;
  three.replace(three.find("ATOMS\n2"), 7, "ATOMS\n3");
  EXPECT_NE(problem(three).find("3 balls"), std::string::npos);
}

}  // namespace
