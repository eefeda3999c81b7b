"""Floods and malformed messages on each topic that a node of the running graph subscribes to."""
import copy
import random
import threading
import time

import rospy
from fault import EITHER, Fault
from message_generator import MessageGenerator, fill_with_nan, has_floats, subscribed_topics

FLOOD, FLOOD_S = 2000, 2.0  # messages at most, for so long at most
NUM_NAN = 20
MALFORMED = 300  # messages a topic
COMMANDS = ("/goal", "/move_base_simple/goal", "/move_base/goal", "/waypoints", "/cmd_vel", "/initialpose")


class Samples:
    """The newest message of each topic."""

    def __init__(self, topics):
        self.seen = {}
        for topic, kind in topics:
            rospy.Subscriber(topic, kind, self.take, topic, queue_size=1)

    def take(self, message, topic):
        self.seen[topic] = message

    def newest(self, topic, kind):
        """An empty one where nothing has come."""
        return copy.deepcopy(self.seen.get(topic, kind()))


def send(topic, kind, messages, period_s, limit_s):
    """As a node that comes, speaks and goes."""
    publisher = rospy.Publisher(topic, kind, queue_size=100)
    end = time.monotonic() + 5
    while publisher.get_num_connections() == 0 and time.monotonic() < end:
        time.sleep(0.01)
    end = time.monotonic() + limit_s
    for message in messages:
        publisher.publish(message)
        time.sleep(period_s)
        if time.monotonic() > end:
            break
    time.sleep(0.2)
    publisher.unregister()


def flood(topic, kind, samples):
    send(topic, kind, [samples.newest(topic, kind)] * FLOOD, 0, FLOOD_S)


def send_nan(topic, kind, samples):
    def inject(campaign):
        message = samples.newest(topic, kind)
        fill_with_nan(message)
        send(topic, kind, [message] * NUM_NAN, 0.02, 1)
    return inject


def stop_in_a_flood(topics, samples):
    """The stop service is called while what the rover drives by comes as fast as it can be sent."""
    def inject(campaign):
        floods = [threading.Thread(target=flood, args=(topic, kind, samples)) for topic, kind in topics]
        for thread in floods:
            thread.start()
        time.sleep(FLOOD_S / 2)
        campaign.begin()
        campaign.rover.call("chassis_node/stop")
        for thread in floods:
            thread.join()
    return inject


def feed(topics):
    def inject(campaign):
        generator = MessageGenerator(random.Random(1))
        for topic, kind in topics:
            send(topic, kind, [generator.make(kind) for _ in range(MALFORMED)], 0, FLOOD_S)
    return inject


def release(campaign):
    """Among the malformed messages was an emergency stop."""
    campaign.rover.call("chassis_node/release_emergency_stop")
    time.sleep(2)


def topic_faults():
    topics = subscribed_topics()
    samples = Samples(topics)
    settle = lambda c: time.sleep(1)  # noqa: E731
    rows = [Fault("flood of the newest message of " + topic, lambda c, topic=topic, kind=kind: flood(topic, kind, samples), EITHER,
                  settle, is_load=True) for topic, kind in topics]
    rows += [Fault("no numbers on " + topic, send_nan(topic, kind, samples), EITHER, settle) for topic, kind in topics if has_floats(kind)]
    driven_by = [(topic, kind) for topic, kind in topics if topic in ("/operator_answer", "/goal", "/tf", "/odom")]
    return rows + [
        Fault("stop service called in a flood of goals, poses and answers", stop_in_a_flood(driven_by, samples),
              "stopped by hand", settle, is_load=True),
        Fault("malformed goals, paths, velocities and stated poses",
              feed([(topic, kind) for topic, kind in topics if topic in COMMANDS]), "drives on"),
        Fault("malformed messages on every topic but /clock",
              feed([(topic, kind) for topic, kind in topics if topic != "/clock"]), EITHER, release, 4, is_load=True),
    ]
