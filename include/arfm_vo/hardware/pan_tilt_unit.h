#pragma once

#include <memory>
#include <optional>
#include <string>

#include "arfm_vo/hardware/byte_stream.h"
#include "arfm_vo/hardware/ptu_link.h"

namespace arfm_vo {

/// What the unit says of an axis.
struct PtuAxisProperties {
  double resolution_rad = 0;                    ///< of a count
  int min_position = 0, max_position = 0;       ///< counts
  int speed = 0, min_speed = 0, max_speed = 0;  ///< counts per second

  double MinRad() const { return min_position * resolution_rad; }
  double MaxRad() const { return max_position * resolution_rad; }
};

struct PtuReading {
  double position_rad = 0;
  double time_s = 0;  ///< middle of the query's round trip, on the stream's clock
};

/// A pan-tilt unit on a line: angles in rad, pan positive to the left, tilt positive upwards.
/// Methods throw std::system_error where the line is gone.
class PanTiltUnit {
 public:
  PanTiltUnit(std::unique_ptr<ByteStream> stream, double reply_timeout_s);

  /// Sets the unit's mode and reads resolution, limits, speeds; false where it does not answer
  /// with sense.
  bool Connect();
  const PtuAxisProperties& properties(PtuAxis axis) const { return axes_[Index(axis)].properties; }

  /// The axis' position. Taken only where two queries in a row give the same, or three a steady
  /// motion, and where the axis can have come there since the last reading; else nothing. More
  /// queries must agree where the last reading is not recent and where the line has had faults.
  std::optional<PtuReading> ReadPosition(PtuAxis axis);

  /// Nothing where the angle is within the axis' limits, else a message.
  std::optional<std::string> CheckAngle(PtuAxis axis, double angle_rad) const;
  /// Sends the axis to an angle. Returns nothing where the unit took it, else why not; an angle
  /// outside the limits is refused before it is sent.
  std::optional<std::string> MoveTo(PtuAxis axis, double angle_rad);
  std::optional<std::string> SetSpeed(PtuAxis axis, double speed_rad_s);

  /// True where both axes have been read at rest at their targets, twice.
  bool IsSettled() const;

  void StartHoming();
  /// True once homing has ended; waits at most the reply's timeout.
  bool PollHoming();

  /// True where an axis hit a limit since it was homed: its count is wrong.
  bool HasLostPosition();
  const PtuLinkCounts& counts() const { return link_.counts(); }
  double Now() const { return stream_->Now(); }

 private:
  struct Axis {
    PtuAxisProperties properties;
    int fastest = 0;  ///< counts per second, of all speeds set so far
    std::optional<int> target;
    std::optional<PtuLink::Answer> last;  ///< accepted reading
    int num_at_target = 0;                ///< readings in a row
    int num_implausible = 0;              ///< in a row
  };

  static int Index(PtuAxis axis) { return axis == PtuAxis::kPan ? 0 : 1; }
  bool ReadProperties(PtuAxis axis);
  bool IsWithinLimits(const Axis& axis, const PtuLink::Answer& answer) const;
  bool IsWithinReach(const Axis& axis, const PtuLink::Answer& answer) const;
  bool Accept(Axis& axis, const PtuLink::Answer& answer);

  std::unique_ptr<ByteStream> stream_;
  PtuLink link_;
  Axis axes_[2];
  bool has_lost_position_ = false;
};

}  // namespace arfm_vo
