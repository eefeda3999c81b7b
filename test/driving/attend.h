#pragma once

#include "arfm_vo/driving/operator_watch.h"

namespace arfm_vo {

/// A person who answers at once.
inline void Attend(OperatorWatch& watch, double steady_s) {
  if (const auto challenge = watch.Advance(steady_s, 1)) watch.ObserveAnswer(steady_s, *challenge);
}

}  // namespace arfm_vo
