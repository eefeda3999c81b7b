#pragma once

#include "arfm_vo/mapping/keyframe_record.h"
#include "arfm_vo/mapping/local_map.h"

namespace arfm_vo {

/// Moves keyframes and landmarks to where a global adjustment found them, against the newest
/// keyframe that both know: that one stays where it is.
void ApplyMapUpdate(const MapUpdate& update, LocalMap& map);

}  // namespace arfm_vo
