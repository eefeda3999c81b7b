#include "rehearsal/drawn_sight.h"

#include <algorithm>
#include <utility>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

std::vector<SightRecord> RecordSight(const std::vector<Glimpse>& glimpses,
                                     const std::vector<Rigid3>& map_from_base) {
  std::vector<SightRecord> records;
  for (size_t i = 1; i < glimpses.size(); ++i) {
    const auto &before = glimpses[i - 1].map_from_base, &now = glimpses[i].map_from_base;
    if (!before || !now) continue;
    const Rigid3 step = map_from_base[i - 1].Inverse() * map_from_base[i];
    records.push_back({(*before * step).Inverse() * *now, glimpses[i].uncertainty});
  }
  return records;
}

DrawnSight::DrawnSight(std::vector<SightRecord> records, double latency_s, int seed)
    : records_(std::move(records)), latency_s_(latency_s), engine_(seed) {
  Require(!records_.empty(), "drawn sight: there are no records");
}

Glimpse DrawnSight::Look(double now_s, const Rigid3& world_from_base) {
  const auto drawn =
      static_cast<size_t>(RandomUnit(engine_) * static_cast<double>(records_.size()));
  const SightRecord& record = records_[std::min(drawn, records_.size() - 1)];
  if (world_from_base_) {
    map_from_base_ =
        map_from_base_ * (world_from_base_->Inverse() * world_from_base) * record.step_error;
  }
  world_from_base_ = world_from_base;
  Glimpse glimpse{now_s, now_s + latency_s_, map_from_base_, record.uncertainty};
  glimpse.uncertainty.taken_s = now_s;
  return glimpse;
}

}  // namespace arfm_vo
