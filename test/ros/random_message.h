#pragma once

#include <ros/serialization.h>
#include <ros/time.h>

#include <boost/array.hpp>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace arfm_vo {

/// Spoils the fields of any ROS message: it goes through them as serialization does, so that the
/// message definitions say what there is.
class MessageSpoiler {
 public:
  explicit MessageSpoiler(int seed) : engine_(seed) {}

  /// Changes each field of `message` with a probability of `share`.
  template <class Message>
  void Spoil(Message& message, double share) {
    share_ = share;
    Visit(message);
  }

  /// What serialization calls for each field.
  template <class Field>
  void next(Field& field) {
    Visit(field);
  }

 private:
  bool IsHit() { return std::uniform_real_distribution<>()(engine_) < share_; }
  int Draw(int num) { return std::uniform_int_distribution<>(0, num - 1)(engine_); }

  template <class Field>
  void Visit(Field& field) {
    if constexpr (std::is_floating_point_v<Field>) {
      if (IsHit()) field = static_cast<Field>(DrawReal());
    } else if constexpr (std::is_integral_v<Field>) {
      if (IsHit()) field = DrawInteger<Field>();
    } else {
      ros::serialization::Serializer<Field>::template allInOne<MessageSpoiler, Field&>(*this,
                                                                                       field);
    }
  }
  void Visit(std::string& field) {
    if (IsHit()) field = Strings()[Draw(static_cast<int>(Strings().size()))];
  }
  void Visit(ros::Time& field) {
    if (IsHit())
      field = Draw(2) == 0 ? ros::TIME_MAX : ros::Time(DrawInteger<uint32_t>(), Draw(1000000000));
  }
  template <class Element, class Allocator>
  void Visit(std::vector<Element, Allocator>& field) {
    if (IsHit()) field.resize(Draw(8) == 0 ? 0 : field.size() + Draw(4) * (1 + Draw(20)));
    if (IsHit() && !field.empty()) field.pop_back();
    VisitElements(field);
  }
  template <class Element, size_t size>
  void Visit(boost::array<Element, size>& field) {
    VisitElements(field);
  }
  template <class Elements>
  void VisitElements(Elements& elements) {
    // Long arrays are spoilt at some places only: what is right so far is looked at further.
    const double share = share_;
    if (elements.size() > 16 && share_ < 1) share_ *= 16.0 / static_cast<double>(elements.size());
    for (auto& element : elements) Visit(element);
    share_ = share;
  }

  double DrawReal() {
    const double values[] = {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::denorm_min(),
                             0.0,
                             -0.0,
                             -1.0,
                             1e-300,
                             1e9};
    const int num = static_cast<int>(std::size(values)), i = Draw(num + 4);
    return i < num ? values[i] : std::normal_distribution<>(0, 100)(engine_);
  }
  template <class Integer>
  Integer DrawInteger() {
    using Limits = std::numeric_limits<Integer>;
    const int i = Draw(6);
    if (i == 0) return Limits::max();
    if (i == 1) return Limits::min();
    if (i == 2) return static_cast<Integer>(-1);
    return static_cast<Integer>(Draw(1000));
  }
  static const std::vector<std::string>& Strings() {
    static const std::vector<std::string> strings = {
        "",     "map",   "base_link",          "mono16",
        "bgr8", "32FC1", "bayer_rggb8",        "pan",
        "tilt", "%s%n",  std::string(3, '\0'), std::string(10000, 'x')};
    return strings;
  }

  std::mt19937 engine_;
  double share_ = 0;
};

}  // namespace arfm_vo
