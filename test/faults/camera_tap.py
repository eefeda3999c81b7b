"""The wire between the simulated camera (/stereo) and the odometry (/cameras), and what may happen to pairs on it."""
import copy
import threading

import rospy
from sensor_msgs.msg import CameraInfo, Image

IMAGES = ("left/image_rect", "right/image_rect")
INFOS = ("left/camera_info", "right/camera_info")
KINDS = [(topic, CameraInfo) for topic in INFOS] + [(topic, Image) for topic in IMAGES]


def unchanged(pair):
    return [pair]


class CameraTap:
    """Passes on what `change` makes of each pair {topic: message}: a list of pairs."""

    def __init__(self):
        self.change = unchanged
        self.last = None  # pair as it came
        self.lock = threading.Lock()
        self.waiting = {}  # by stamp
        self.publishers = {}
        self.advertise()
        for topic, kind in KINDS:
            rospy.Subscriber("/stereo/" + topic, kind, lambda message, topic=topic: self.take(topic, message))

    def advertise(self):
        with self.lock:
            for topic, kind in KINDS:
                self.publishers[topic] = rospy.Publisher("/cameras/" + topic, kind, queue_size=10)

    def unadvertise(self):
        """As where the camera's node has ended."""
        with self.lock:
            for publisher in self.publishers.values():
                publisher.unregister()
            self.publishers.clear()

    def take(self, topic, message):
        with self.lock:
            pair = self.waiting.setdefault(message.header.stamp, {})
            pair[topic] = message
            if len(pair) < len(KINDS):
                return
            self.waiting = {stamp: other for stamp, other in self.waiting.items() if stamp > message.header.stamp}
            changes = self.change(pair)
            self.last = pair
            for changed in changes:
                for name, publisher in self.publishers.items():
                    publisher.publish(changed[name])


def with_data(image, data):
    changed = copy.copy(image)
    changed.data = data
    return changed


def cover(*topics):
    """Black pictures."""
    return lambda pair: [{**pair, **{name: with_data(pair[name], bytes(len(pair[name].data))) for name in topics}}]


def freeze(seen, names=IMAGES):
    """The pictures of a pair that was seen, with new stamps."""
    return lambda pair: [{**pair, **{name: with_data(pair[name], seen[name].data) for name in names}}]


def darken(pair, gain=0.5):
    grey = bytes(int(gain * value) for value in range(256))
    return [{**pair, **{name: with_data(pair[name], bytes(pair[name].data).translate(grey)) for name in IMAGES}}]


class Hold:
    """Pairs wait, and come all at once when they are let go."""

    def __init__(self):
        self.pairs, self.is_let_go = [], False

    def __call__(self, pair):
        self.pairs.append(pair)
        if not self.is_let_go:
            return []
        pairs, self.pairs = self.pairs, []
        return pairs


class Settling:
    """The exposure begins at half and settles in 3 s, as that of a camera that was switched on."""

    def __init__(self):
        self.begin_s = None

    def __call__(self, pair):
        stamp_s = pair[IMAGES[0]].header.stamp.to_sec()
        self.begin_s = self.begin_s or stamp_s
        return darken(pair, min(1, 0.5 + (stamp_s - self.begin_s) / 6))


def swap(pair):
    left, right = IMAGES
    return [{**pair, left: pair[right], right: pair[left]}]


def recalibrate(pair):
    changed = dict(pair)
    for name in INFOS:
        changed[name] = copy.copy(pair[name])
        changed[name].P = [1.1 * value if i in (0, 5) else value for i, value in enumerate(pair[name].P)]
    return [changed]


class AgainOnce:
    """One pair comes a second time after the next two."""

    def __init__(self):
        self.pairs = []

    def __call__(self, pair):
        self.pairs.append(pair)
        return [pair, self.pairs[0]] if len(self.pairs) == 3 else [pair]
