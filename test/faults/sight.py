"""Where the rover is told to be, beside where it truly is."""
import bisect
import cmath
import math

import rospy
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

MAX_ERROR_M, MAX_ERROR_RAD = 0.10, math.radians(10)  # of a pose that is right
KEPT = 3000


# A pose on the plane is its place and its heading, complex numbers: x + iy, and one of size 1.
ORIGIN = (0j, 1 + 0j)


def planar(place, rotation):
    """Of a position and a quaternion."""
    x, y, z, w = rotation.x, rotation.y, rotation.z, rotation.w
    return complex(place.x, place.y), cmath.rect(1, math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z)))


def compose(a_from_b, b_from_c):
    return a_from_b[0] + a_from_b[1] * b_from_c[0], a_from_b[1] * b_from_c[1]


def relative(a_from_b, a_from_c):
    """b_from_c."""
    return (a_from_c[0] - a_from_b[0]) / a_from_b[1], a_from_c[1] / a_from_b[1]


class Sight:
    """What tf and the odometry tell, and the truth, since the mark."""

    def __init__(self, way_m):
        self.way_m = way_m  # of the tracks, now
        self.truths = {}  # places by stamp
        self.edges = {"odom": ORIGIN, "base_link": ORIGIN}  # of tf, by the child frame
        self.told = []  # (stamp, map_from_base, way)
        rospy.Subscriber("base_truth", Odometry, self.take_truth)
        rospy.Subscriber("/tf", TFMessage, self.take_transforms, queue_size=100)

    def take_truth(self, message):
        pose = message.pose.pose
        self.truths[message.header.stamp.to_sec()] = planar(pose.position, pose.orientation)
        while len(self.truths) > KEPT:
            del self.truths[next(iter(self.truths))]

    def take_transforms(self, message):
        for transform in message.transforms:
            edge = planar(transform.transform.translation, transform.transform.rotation)
            if transform.child_frame_id not in self.edges or not all(map(cmath.isfinite, edge)):
                continue
            self.edges[transform.child_frame_id] = edge
            stamp = transform.header.stamp.to_sec() if transform.child_frame_id == "base_link" else None
            if stamp is None and self.told:
                stamp = self.told[-1][0]  # the map has moved under the last pose
            if stamp is not None:
                self.told.append((stamp, compose(self.edges["odom"], self.edges["base_link"]), self.way_m()))

    def mark(self):
        """From here on."""
        del self.told[:-1]

    def truth_at(self, stamp):
        stamps = sorted(self.truths)
        i = bisect.bisect_left(stamps, stamp - 1e-6)
        if i < len(stamps) and abs(stamps[i] - stamp) < 1e-3:
            return self.truths[stamps[i]]
        if not 0 < i < len(stamps):
            return None
        before, after = self.truths[stamps[i - 1]], self.truths[stamps[i]]
        share = (stamp - stamps[i - 1]) / (stamps[i] - stamps[i - 1])
        place, heading = relative(before, after)
        return compose(before, (share * place, heading ** share))

    def is_wrong(self, told, reference):
        """Whether the pose is off the truth since the reference; one of no known time is nobody's."""
        truths = [self.truth_at(stamp) for stamp in (reference[0], told[0])]
        if None in truths:
            return False
        place, heading = relative(relative(*truths), relative(reference[1], told[1]))
        return abs(place) > MAX_ERROR_M or abs(cmath.phase(heading)) > MAX_ERROR_RAD

    def wrong_way_m(self, end_way_m):
        """How far the tracks have gone since the mark while the newest pose that was told was wrong."""
        told = list(self.told)
        if not told:
            return 0.0
        ends_m = [later[2] for later in told[1:]] + [end_way_m]
        return sum(abs(end_m - pose[2]) for pose, end_m in zip(told, ends_m) if self.is_wrong(pose, told[0]))

    def distance_m(self):
        """From where the drive began."""
        return abs(next(reversed(self.truths.values()))[0]) if self.truths else 0.0
