#include "softgrain/io/page/report_frame.hpp"

#include <doctest/doctest.h>

using namespace softgrain;

TEST_CASE("contacts of particles with walls are shown, the walls counted on from the particles") {
  Scene scene;
  scene.particles["position"] = {2, std::vector<double>{0, 0, 2, 0, 4, 0}};
  scene.particles["radius"] = {1, std::vector<double>{1, 1, 1}};
  scene.contacts["pair"] = {2, std::vector<std::int64_t>{0, 1, 2, 3, 1, 4}};  // 3 is the floor, 4 nothing
  scene.contacts["force"] = {1, std::vector<double>{5, 6, 7}};
  scene.wall_segments = {-1, -1, 5, -1};
  const ReportFrame frame = frame_of(scene);
  CHECK(frame.columns.at("contact.a") == std::vector<float>{0, 2});
  CHECK(frame.columns.at("contact.b") == std::vector<float>{1, 3});
  CHECK(frame.columns.at("contact.force") == std::vector<float>{5, 6});
}
