#!/usr/bin/python3
"""config/rover.nft in two network namespaces, a rover's and a stranger's, joined by a cable (veth).

The rover's ROS is as careless as can be: master and node listen on the outside address. Without the rules the stranger
publishes goal, cmd_vel and emergency_stop and calls start; with them nothing of his arrives, and the rover's own does.
Needs root, ip and nft; where they are not there or not permitted the test says so and is skipped (exit status 77).
"""
import os
import re
import shutil
import subprocess
import sys
import time

SKIPPED = 77
RULES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "config", "rover.nft")
ROVER, STRANGER, PORT = "10.213.7.1", "10.213.7.2", 11311
RULES_FAULT = re.compile("Error: (Could not resolve|syntax error)")  # the file's own; all else is the kernel's answer
TOPICS = ("goal", "cmd_vel", "emergency_stop")

# A node on the rover: prints what comes.
LISTEN = """
import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Trigger, TriggerResponse
rospy.init_node("chassis_node")
def tell(name):
    print(name, flush=True)
    return TriggerResponse(True, "")
for name in %r:
    rospy.Subscriber(name, Empty, lambda message, name=name: tell(name))
rospy.Service("~start", Trigger, lambda request: tell("start"))
print("ready", flush=True)
rospy.spin()
""" % (TOPICS,)

# Publishes and calls all of that again and again until it is ended: on a busy machine one call may find no answer.
SPEAK = """
import time
import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Trigger
rospy.init_node("speaker", anonymous=True)
publishers = [rospy.Publisher(name, Empty, queue_size=1) for name in %r]
while not rospy.is_shutdown():
    time.sleep(0.5)
    try:
        for publisher in publishers:
            publisher.publish(Empty())
        rospy.ServiceProxy("chassis_node/start", Trigger)()
    except (rospy.ServiceException, OSError):
        pass
""" % (TOPICS,)


class Namespace:
    """A network namespace, held by a process that sleeps."""

    def __init__(self):
        self.keeper = subprocess.Popen(["unshare", "-n", "sleep", "600"], stderr=subprocess.DEVNULL)
        self.processes = [self.keeper]
        own = os.readlink("/proc/self/ns/net")
        for _ in range(100):
            if self.keeper.poll() is not None:
                skip("unshare -n is not permitted")
            if os.readlink(f"/proc/{self.keeper.pid}/ns/net") != own:
                return
            time.sleep(0.02)
        skip("unshare made no namespace")

    def command(self, *words):
        return ["nsenter", "-t", str(self.keeper.pid), "-n", *words]

    def run(self, *words, fault=None):
        """Where it fails the test is skipped; not where it says `fault`."""
        done = subprocess.run(self.command(*words), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0:
            check(fault is None or not fault.search(done.stdout), f"{' '.join(words)}: {done.stdout.strip()}")
            skip(f"{' '.join(words)}: {done.stdout.strip()}")

    def python(self, program, address, master):
        """A program in here whose ROS has this address."""
        environment = {**os.environ, "ROS_IP": address, "ROS_MASTER_URI": f"http://{master}:{PORT}",
                       "PYTHONPATH": "/usr/lib/python3/dist-packages"}
        process = subprocess.Popen(self.command("/usr/bin/python3", "-c", program), env=environment, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.processes.append(process)
        return process

    def end(self):
        for process in self.processes:
            process.kill()
            process.wait()


def skip(why):
    print("SKIPPED: " + why)
    sys.exit(SKIPPED)


def join(rover, stranger):
    subprocess.run(rover.command("ip", "link", "add", "cable", "type", "veth", "peer", "name", "other"), check=True)
    rover.run("ip", "link", "set", "other", "netns", str(stranger.keeper.pid))
    for side, name, address in ((rover, "cable", ROVER), (stranger, "other", STRANGER)):
        side.run("ip", "address", "add", address + "/24", "dev", name)
        side.run("ip", "link", "set", name, "up")
        side.run("ip", "link", "set", "lo", "up")


def hear(rover, side, address, expected):
    """What a new node on the rover hears from a speaker on that side: until it is what is expected, or for some seconds."""
    listener = rover.python(LISTEN, ROVER, ROVER)
    check(listener.stdout.readline() == "ready\n", "the rover's node runs")
    speaker = side.python(SPEAK, address, ROVER)
    heard = set()
    os.set_blocking(listener.stdout.fileno(), False)
    end = time.monotonic() + (60 if expected else 10)
    while time.monotonic() < end and (heard != expected or not expected):
        time.sleep(0.05)
        try:
            heard |= set(os.read(listener.stdout.fileno(), 65536).decode().split())
        except BlockingIOError:
            pass
    speaker.kill()
    listener.kill()
    return heard


def connects(side, port):
    probe = f"import socket; socket.create_connection(('{ROVER}', {port}), 2)"
    return subprocess.run(side.command("/usr/bin/python3", "-c", probe), stderr=subprocess.DEVNULL).returncode == 0


def check(condition, what):
    print(("ok: " if condition else "FAILED: ") + what)
    if not condition:
        sys.exit(1)


def run(rover, stranger):
    join(rover, stranger)
    rover.python("import socket, time\nend = socket.create_server(('', 22))\ntime.sleep(600)", ROVER, ROVER)  # as sshd
    rover.python(f"import rosmaster.main\nrosmaster.main.rosmaster_main(['rosmaster', '--core', '-p', '{PORT}'])", ROVER, ROVER)
    check(any(connects(rover, PORT) or time.sleep(0.2) for _ in range(100)), "the master runs")
    everything = set(TOPICS) | {"start"}
    check(hear(rover, stranger, STRANGER, everything) == everything, "without the rules a stranger commands the rover")
    for _ in range(2):  # once more is no error
        rover.run("nft", "-f", RULES, fault=RULES_FAULT)
    check(not connects(stranger, PORT), "with the rules he does not reach the master")
    check(hear(rover, stranger, STRANGER, set()) == set(), "nothing that he says arrives")
    check(connects(stranger, 22), "ssh is reached")
    heard = hear(rover, rover, ROVER, everything)
    check(heard == everything, f"what is said on the rover arrives: {sorted(heard)}")


def main():
    if os.geteuid() != 0:
        skip("needs root")
    for program in ("ip", "nft", "nsenter", "unshare"):
        if shutil.which(program, path="/usr/sbin:/sbin:/usr/bin:/bin") is None:
            skip(f"there is no {program}")
    os.environ["PATH"] = "/usr/sbin:/sbin:" + os.environ["PATH"]
    sides = []
    try:
        sides = [Namespace(), Namespace()]
        run(*sides)
    finally:
        for side in sides:
            side.end()


if __name__ == "__main__":
    main()
