#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/configuration/yaml_writer.h"
#include "arfm_vo/ros/rover/chassis_node.h"
#include "arfm_vo/ros/rover/pan_tilt_node.h"
#include "arfm_vo/ros/rover/simulator_node.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Sets every number of an options struct, and of those in it, to infinity in turn.
class SetNth {
 public:
  explicit SetNth(int n) : n_(n) {}

  template <class Field>
  void operator()(const char* name, Field& field) {
    if constexpr (std::is_same_v<Field, double>) {
      if (count_++ == n_) {
        field = kInfinite;
        name_ = name;
      }
    } else if constexpr (kHasFields<Field>) {
      field.VisitFields(*this);
    }
  }
  const std::string& name() const { return name_; }

 private:
  int n_, count_ = 0;
  std::string name_;
};

template <class Options>
void ExpectNoInfiniteLimit() {
  for (int n = 0;; ++n) {
    Options options;
    SetNth set(n);
    options.VisitFields(set);
    if (set.name().empty()) {
      EXPECT_GT(n, 0);
      return;
    }
    EXPECT_THROW(ReadYaml(YAML::Load(WriteYaml(options)), "", options), std::invalid_argument)
        << set.name();
  }
}

TEST(InfiniteLimits, AreRefusedByTheChassisNode) { ExpectNoInfiniteLimit<ChassisNodeOptions>(); }

TEST(InfiniteLimits, AreRefusedByTheHead) { ExpectNoInfiniteLimit<PanTiltNodeOptions>(); }

TEST(InfiniteLimits, AreRefusedByTheSimulator) {
  SimulatorNodeOptions options;
  options.max_speed_up = kInfinite;
  EXPECT_INVALID(options.Check(), "max_speed_up");
  options = SimulatorNodeOptions();
  options.max_latency_s = kInfinite;
  EXPECT_INVALID(options.Check(), "max_latency_s");
}

}  // namespace
}  // namespace arfm_vo
