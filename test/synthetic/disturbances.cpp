#include "synthetic/disturbances.h"

#include "synthetic/pair_changes.h"

namespace arfm_vo {
namespace {

constexpr auto kLeft = &StereoImages::left, kRight = &StereoImages::right;
constexpr PairRange kAlways, kOn{kFrom};

constexpr PairRange For(int num_pairs) { return {kFrom, kFrom + num_pairs}; }

}  // namespace

std::vector<Disturbance> MakeDisturbances() {
  return {
      {"none", [](int, StereoImages&) {}},
      {"noise", OnEachImage(AddNoiseOf(15))},
      {"blur", OnEachImage(Blur(11))},
      {"jpeg", OnEachImage(CompressAsJpeg(25))},
      {"rows", ShiftRows(2, kAlways)},
      {"rows-5-pairs", ShiftRows(2, For(5))},
      {"exposure", AlternateExposure(0.5, 2)},
      {"object-40", Show({0.4})},
      {"object-60", Show({0.6})},
      {"object-40-sideways", Show({0.4, {4, 0}})},
      {"object-40-approaching", Show({0.4, {0, 0}, 0.01})},
      {"black-10-pairs", Both(Blacken(kLeft, For(10)), Blacken(kRight, For(10)))},
      {"right-black", Blacken(kRight, kOn)},
      {"right-frozen", Freeze(kRight, kOn)},
      {"right-late", DelayRight(1)},
      {"frozen-20-pairs", Both(Freeze(kLeft, For(20)), Freeze(kRight, For(20)))},
      {"cameras-swapped", SwapImages(kAlways)},
      {"cameras-swapped-10-pairs", SwapImages(For(10))},
  };
}

std::vector<Disturbance> MakeMoreDisturbances() {
  return {
      {"noise-5", OnEachImage(AddNoiseOf(5))},
      {"noise-30", OnEachImage(AddNoiseOf(30))},
      {"right-noise-30", OnSide(kRight, AddNoiseOf(30))},
      {"blur-5", OnEachImage(Blur(5))},
      {"blur-21", OnEachImage(Blur(21))},
      {"blur-sideways-15", OnEachImage(SmearSideways(15))},
      {"jpeg-50", OnEachImage(CompressAsJpeg(50))},
      {"jpeg-10", OnEachImage(CompressAsJpeg(10))},
      {"jpeg-5", OnEachImage(CompressAsJpeg(5))},
      {"dark-0.25", OnEachImage(Multiply(0.25))},
      {"bright-3", OnEachImage(Multiply(3))},
      {"dusk", DriftExposure(0.1, 60)},
      {"right-dark-0.5", OnSide(kRight, Multiply(0.5))},
      {"dead-rows-5", OnEachImage(KillRows(0.05))},
      {"dead-columns-5", OnEachImage(KillColumns(0.05))},
      {"missing-every-3rd", Miss(3)},
      {"missing-5-pairs", Miss(For(5))},
      {"missing-15-pairs", Miss(For(15))},
      {"missing-2-of-12-untimed", MissUntimed(2, 12)},
      {"skew-2-ms", Skew(0.002)},
      {"skew-10-ms", Skew(0.010)},
      {"skew-20-ms", Skew(0.020)},
      {"object-10", Show({0.1})},
      {"object-20", Show({0.2})},
      {"object-10-sideways", Show({0.1, {4, 0}})},
      {"object-60-sideways", Show({0.6, {4, 0}})},
      {"object-20-approaching", Show({0.2, {0, 0}, 0.01})},
      {"object-60-approaching", Show({0.6, {0, 0}, 0.01})},
      {"object-20-receding", Show({0.2, {0, 0}, -0.01})},
      {"object-40-receding", Show({0.4, {0, 0}, -0.01})},
      {"object-20-rising", Show({0.2, {0, -2}})},
      {"object-40-rising", Show({0.4, {0, -2}})},
      {"object-20-swinging", Show({0.2, {0, 0}, 0, 30})},
      {"object-40-swinging", Show({0.4, {0, 0}, 0, 30})},
      {"rain-200", OnEachImage(DrawRain(200))},
      {"rain-1000", OnEachImage(DrawRain(1000))},
      {"glare-0.2", OnEachImage(DrawGlare(0.2))},
      {"glare-0.5", OnEachImage(DrawGlare(0.5))},
      {"contrast-0.3", OnEachImage(Flatten(0.3))},
      {"contrast-0.1", OnEachImage(Flatten(0.1))},
      {"left-dirt-20", OnSide(kLeft, Dirty(0.2, 1))},
      {"dirt-30", Both(OnSide(kLeft, Dirty(0.3, 1)), OnSide(kRight, Dirty(0.3, 2)))},
      {"drift-pitch", TurnRight({0.002, 0, 0}, {0, 60})},
      {"drift-yaw", TurnRight({0, 0.002, 0}, {0, 60})},
      {"drift-roll", TurnRight({0, 0, 0.005}, {0, 60})},
      {"ramp-yaw", TurnRight({0, 0.001, 0}, {kFrom, kFrom + 20})},
      {"step-yaw", TurnRight({0, 0.001, 0}, {kFrom, kFrom + 1})},
      {"step-pitch", TurnRight({0.001, 0, 0}, {kFrom, kFrom + 1})},
  };
}

}  // namespace arfm_vo
