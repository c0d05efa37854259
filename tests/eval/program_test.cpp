// SPDX-License-Identifier: MIT
// unisim-eval as a program: figures, JSON, plot, exit codes, one line on stderr.
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/catch.hpp"
#include "tests/support/program_in_folder.hpp"

namespace {

// A square of 2 m and the same drawn twice as large, with one corner 1 m too high.
constexpr const char* kTruthText =
    "0 0 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 2 2 0 0 0 0 1\n3 0 2 0 0 0 0 1\n";
constexpr const char* kEstimate =
    "# half time steps are not in the truth\n0 0 0 0 0 0 0 1\n1.01 4 0 1 0 0 0 1\n1.5 9 9 9 0 0 0 "
    "1\n"
    "2 4 4 0 0 0 0 1\nnan 1 1 1 0 0 0 1\n3 0 4 0 0 0 0 1\n";

class Program : public ProgramInFolder {
 public:
  Program() : ProgramInFolder(UNISIM_EVAL_PROGRAM) {
    folder().write("gt.txt", kTruthText);
    folder().write("est.txt", kEstimate);
  }

  /// And nothing on stdout.
  void require_failure(const std::string& arguments, int code, const std::string& part) {
    ProgramInFolder::require_failure(arguments, code, part);
    REQUIRE(out.empty());
  }
};

}  // namespace

TEST_CASE("ate prints its protocol and figures") {
  Program program;
  REQUIRE(program.run("ate gt.txt est.txt --align none --json") == 0);
  const auto json = nlohmann::json::parse(program.out);
  REQUIRE(json["metric"] == "ate");
  REQUIRE(json["protocol"]["alignment"] == "none");
  REQUIRE(json["protocol"]["associated"] == 4);
  REQUIRE(json["protocol"]["max_dt_s"] == 0.02);
  REQUIRE(json["protocol"]["estimate"]["skipped_lines"] == 1);
  // Errors 0, sqrt(5), sqrt(8), 2.
  REQUIRE(json["rmse"].get<double>() == Approx(std::sqrt(17.0 / 4)));
  REQUIRE(json["max"].get<double>() == Approx(std::sqrt(8.0)));
  REQUIRE(json["scale"] == 1.0);
  REQUIRE(program.run("ate gt.txt est.txt --align none") == 0);
  REQUIRE(program.out.find("alignment            none\n") != std::string::npos);
  REQUIRE(program.out.find("associated           4\n") != std::string::npos);
  REQUIRE(program.out.find("rmse                 2.061552813 m\n") != std::string::npos);
  REQUIRE(program.err.empty());
}

TEST_CASE("ate aligns by sim3 unless told otherwise and draws a plot") {
  Program program;
  REQUIRE(program.run("ate gt.txt est.txt --json --plot top.png") == 0);
  const auto json = nlohmann::json::parse(program.out);
  REQUIRE(json["protocol"]["alignment"] == "sim3");
  REQUIRE(json["scale"].get<double>() < 0.6);
  const cv::Mat plot = cv::imread(program.folder() / "top.png");
  REQUIRE(plot.cols == 900);
  REQUIRE(cv::norm(plot, cv::Mat(plot.size(), plot.type(), cv::Scalar::all(255)), cv::NORM_INF) >
          100);
}

TEST_CASE("rpe takes step and unit") {
  Program program;
  REQUIRE(program.run("rpe gt.txt est.txt --align none --delta 2 --unit frames --json") == 0);
  auto json = nlohmann::json::parse(program.out);
  REQUIRE(json["pairs"] == 1);
  REQUIRE(json["protocol"]["delta"] == 2);
  // Two frames on the truth has moved by (2, 2, 0), the estimate by (4, 4, 0).
  REQUIRE(json["translation"]["rmse"].get<double>() == Approx(std::sqrt(8.0)));
  REQUIRE(json["rotation"]["rmse"] == 0.0);
  REQUIRE(program.run("rpe gt.txt est.txt --align none --delta 1 --unit s --json") == 0);
  json = nlohmann::json::parse(program.out);
  REQUIRE(json["protocol"]["delta_unit"] == "s");
  REQUIRE(json["pairs"] == 2);
}

TEST_CASE("consistency judges the folder of a run") {
  Program program;
  program.folder().write("trajectory.tum", kEstimate);
  program.folder().write("keyframes.csv",
                         "timestamp,segment,state,confidence,position_sigma,rotation_sigma\n"
                         "0,0,tracking,2,1,0.1\n1.01,0,tracking,3,0.001,0.1\n2,0,tracking,3,1,0.1\n"
                         "3,0,degraded,3,,\n");
  REQUIRE(program.run("consistency gt.txt . --json") == 0);
  const auto json = nlohmann::json::parse(program.out);
  REQUIRE(json["metric"] == "consistency");
  REQUIRE(json["protocol"]["associated"] == 4);
  REQUIRE(json["position"]["poses"] == 3);
  REQUIRE(json["position"]["beyond_3_sigma"].get<double>() == Approx(1.0 / 3));
  REQUIRE(json["without_sigma"] == 1);
  REQUIRE(json["good"] == 3);
  REQUIRE(json["good_far_off"] == 0);
  REQUIRE(json["confidence_2"]["poses"] == 1);
  REQUIRE(program.run("consistency gt.txt .") == 0);
  REQUIRE(program.out.find("position beyond_3_sigma 0.333333333\n") != std::string::npos);
  REQUIRE(program.out.find("good_far_off         0\n") != std::string::npos);
  program.require_failure("consistency gt.txt nowhere", 3, "keyframes.csv");
  program.folder().write("keyframes.csv", "timestamp,segment\n0,0\n");
  program.require_failure("consistency gt.txt .", 3, "no column confidence");
}

TEST_CASE("cloud compares PLY files, moved as the trajectories align") {
  Program program;
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  program.folder().write("gt.ply", header + "0 0 0\n1 0 0\n0 1 0\n");
  program.folder().write("est.ply", header + "0 0 0\n2 0 0\n0 2 0\n");
  REQUIRE(program.run("cloud gt.ply est.ply --json") == 0);
  REQUIRE(nlohmann::json::parse(program.out)["accuracy"].get<double>() ==
          Approx(std::sqrt(2.0 / 3)));
  program.folder().write("twice.txt",
                         "0 0 0 0 0 0 0 1\n1 4 0 0 0 0 0 1\n2 4 4 0 0 0 0 1\n3 0 4 0 0 0 0 1\n");
  REQUIRE(program.run("cloud gt.ply est.ply --trajectories gt.txt twice.txt --json") == 0);
  const auto json = nlohmann::json::parse(program.out);
  REQUIRE(json["accuracy"].get<double>() < 1e-9);
  REQUIRE(json["completeness"].get<double>() < 1e-9);
  REQUIRE(json["chamfer"].get<double>() < 1e-9);
}

TEST_CASE("bad usage is exit code 2") {
  Program program;
  program.require_failure("", 2, "--help");
  program.require_failure("ate gt.txt", 2, "EST");
  program.require_failure("ate gt.txt est.txt --align se2", 2, "se2");
  program.require_failure("ate gt.txt est.txt --nonsense", 2, "nonsense");
  program.require_failure("rpe gt.txt est.txt --delta 0", 2, "above 0");
  program.require_failure("rpe gt.txt est.txt --delta 1.5", 2, "whole");
  program.require_failure("rpe gt.txt est.txt --unit km", 2, "km");
  REQUIRE(program.run("--help") == 0);
}

TEST_CASE("every number has a range, and what is outside is told with its option") {
  Program program;
  for (const std::string value : {"inf", "nan", "-1", "1e400", "x", "''"}) {
    program.require_failure("ate gt.txt est.txt --max-dt " + value, 2, "--max-dt");
    program.require_failure("rpe gt.txt est.txt --delta " + value, 2, "--delta");
    program.require_failure("cloud gt.txt est.txt --max-distance " + value, 2, "--max-distance");
  }
  program.require_failure("ate gt.txt est.txt --max-dt 1e10", 2, "from 0 up to 1e+09");
}

TEST_CASE("a step longer than the trajectory is bad input, however long") {
  Program program;
  for (const std::string unit : {"frames", "m", "s"}) {
    for (const std::string delta : {"4", "1e9", "1e18", "1e19", "1e30", "1e300"}) {
      if (delta == "4" && unit == "m") continue;  // the square has a side longer than that
      const std::string step = " --unit " + unit + " --delta " + delta;
      program.require_failure("rpe gt.txt gt.txt" + step, 3, "no step of ");
      program.require_failure("rpe gt.txt gt.txt --all-pairs" + step, 3, "no step of ");
    }
  }
}

TEST_CASE("bad input is exit code 3") {
  Program program;
  program.folder().write("words.txt", "no poses here\n");
  program.folder().write("late.txt", "1000 0 0 0 0 0 0 1\n1001 1 0 0 0 0 0 1\n");
  program.require_failure("ate gt.txt missing.txt", 3, "missing.txt");
  program.require_failure("ate gt.txt words.txt", 3, "words.txt:1");
  program.require_failure("ate gt.txt late.txt", 3, "1000.000000 to 1001.000000 s");
  program.folder().write("point.txt", "0 1 1 1 0 0 0 1\n1 1 1 1 0 0 0 1\n2 1 1 1 0 0 0 1\n");
  program.folder().write("two.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  program.require_failure("ate gt.txt late.txt", 3, "--max-dt");
  program.require_failure("ate gt.txt point.txt", 3, "--align none");
  program.require_failure("ate gt.txt two.txt", 3, "2 associated positions");
  program.require_failure("rpe gt.txt est.txt --delta 50", 3, "smaller --delta");
  program.require_failure("cloud gt.txt est.txt", 3, "not a PLY file");
}

TEST_CASE("what is odd about the files is noted beside the figures") {
  Program program;
  program.folder().write(
      "odd.txt",
      "3 0 2 0 0 0 0 1\n0 0 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n1 9 9 9 0 0 0 1\n2 2 2 "
      "0 0 0 0 1\n");
  REQUIRE(program.run("ate gt.txt odd.txt --json") == 0);
  const auto json = nlohmann::json::parse(program.out);
  REQUIRE(json["rmse"].get<double>() < 1e-12);
  REQUIRE(json["notes"].size() == 2);
  REQUIRE(program.err.find("unisim-eval: odd.txt: not in the order of time") != std::string::npos);
  REQUIRE(program.err.find("unisim-eval: odd.txt: 1 pose has the time") != std::string::npos);
  REQUIRE(program.run("ate odd.txt odd.txt") == 0);
  REQUIRE(program.out.find("max                  0.000000000 m\n") != std::string::npos);
}

TEST_CASE("a straight line is scored, but turns no cloud") {
  Program program;
  program.folder().write("line.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  REQUIRE(program.run("ate line.txt line.txt --json") == 0);
  REQUIRE(nlohmann::json::parse(program.out)["rmse"].get<double>() < 1e-12);
  REQUIRE(program.err.find("on a straight line") != std::string::npos);
  program.require_failure("cloud a.ply b.ply --trajectories line.txt line.txt", 3,
                          "on a straight line");
}

TEST_CASE("KITTI files of different lengths are refused, frame numbers make them comparable") {
  Program program;
  std::string all, some, numbered;
  for (int k = 0; k < 12; ++k) {
    const std::string matrix = "1 0 0 " + std::to_string(k * k) + " 0 1 0 " + std::to_string(k) +
                               " 0 0 1 " + std::to_string(k % 3) + "\n";
    all += matrix;
    if (k % 3 == 0) some += matrix;
    if (k % 3 == 0) numbered += std::to_string(k) + " " + matrix;
  }
  program.folder().write("all.txt", all);
  program.folder().write("some.txt", some);
  program.folder().write("numbered.txt", numbered);
  for (const std::string files : {"all.txt some.txt", "some.txt all.txt"}) {
    program.require_failure("ate " + files, 3, "frame number");
    program.require_failure("rpe " + files, 3, "frame number");
  }
  REQUIRE(program.run("ate all.txt numbered.txt --json") == 0);
  auto json = nlohmann::json::parse(program.out);
  REQUIRE(json["rmse"].get<double>() < 1e-12);
  REQUIRE(json["protocol"]["associated_by"] == "frame number");
  REQUIRE(program.run("ate all.txt all.txt --json") == 0);
  json = nlohmann::json::parse(program.out);
  REQUIRE(json["protocol"]["associated_by"] == "line");
}

TEST_CASE("a plot that cannot be written is exit code 4, the figures are kept") {
  Program program;
  REQUIRE(program.run("ate gt.txt est.txt --plot missing/folder/top.png") == 4);
  REQUIRE(program.out.find("rmse") != std::string::npos);
  REQUIRE(program.err.find("missing/folder/top.png") != std::string::npos);
}
