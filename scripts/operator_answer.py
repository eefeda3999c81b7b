#!/usr/bin/python3
"""Answers a rover's challenges while a person attends it in this terminal, on the person's own machine, without ROS.

COMMAND starts the relay on the rover, such as: ssh rover '. ws/devel/setup.sh; rosrun arfm_vo operator_answer.py --relay'
(default: here). Enter stops the rover, by chassis_guard and by chassis_node/stop; so do Ctrl-C, a closed or stopped terminal
and a lost link.
"""
import argparse
import itertools
import os
import select
import signal
import socket
import subprocess
import sys


def attend(relay, name):
    """Says why it ends. One thread: what does not read the terminal answers nothing."""
    rover = name
    while True:
        readable, _, _ = select.select([0, relay.stdout], [], [])
        if 0 in readable:
            if not os.read(0, 4096):
                return "the terminal is gone"
            relay.stdin.write(b"stop\n")
        line = relay.stdout.readline() if relay.stdout in readable else None
        if line == b"":
            return "the relay has ended"
        if line is None or tell(line):
            continue
        heard = line.decode().rstrip("\n").split(" ", 3)[3]
        if rover is None:
            rover = heard
            print("attends %s: Enter stops it, Ctrl-C ends the watch" % rover, flush=True)
        # (Nobody can press Enter where another program reads the terminal.)
        if heard == rover and (not os.isatty(0) or os.tcgetpgrp(0) == os.getpgrp()):
            relay.stdin.write(line)
        elif heard != rover and name is None:
            return "there is another rover, %s: name yours with --rover" % heard


def tell(line):
    """Shows what is no challenge, and says whether it was none."""
    if line.startswith(b"challenge "):
        return False
    print(line.decode(), end="", flush=True)
    return True


def relay(stop_port):
    """On the rover: challenges to the person, answers and stops back."""
    guard = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    guard.connect(("127.0.0.1", stop_port))
    guard.settimeout(0.2)
    import rospy
    from arfm_vo.msg import OperatorChallenge
    from std_srvs.srv import Trigger
    rospy.init_node("operator", anonymous=True, disable_signals=True)
    answers = rospy.Publisher("operator_answer", OperatorChallenge, queue_size=1, tcp_nodelay=True)
    rospy.Subscriber("operator_challenge", OperatorChallenge, queue_size=1, tcp_nodelay=True, callback=lambda challenge: print(
        "challenge %d %d %s" % (challenge.sequence, challenge.number, challenge.rover), flush=True))
    for line in itertools.chain(iter(sys.stdin.readline, ""), ["stop"]):
        words = line.rstrip("\n").split(" ", 3)
        if words[0] == "challenge":
            answers.publish(sequence=int(words[1]), number=int(words[2]), rover=words[3])
            continue
        try:  # first what needs no ROS master
            guard.send(b"stop")
            print("stop:", guard.recv(100).decode(), flush=True)
        except OSError:
            print("stop: there is no chassis_guard at port %d" % stop_port, flush=True)
        try:
            print("stop:", rospy.ServiceProxy("chassis_node/stop", Trigger)().message, flush=True)
        except rospy.ServiceException as error:
            return print("stop: no answer: %s; without answers to its challenges the rover stops too" % error, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rover", metavar="NAME", help="its name; without it, the only one that is heard")
    parser.add_argument("--relay", action="store_true", help="the end on the rover, started by the person's")
    parser.add_argument("--stop-port", type=int, default=4700, metavar="PORT", help="with --relay: UDP, of chassis_guard")
    parser.add_argument("command", metavar="COMMAND", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    if arguments.relay:
        return relay(arguments.stop_port)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of the relay: Ctrl-C must find it alive, so that it still stops the rover
    process = subprocess.Popen(arguments.command or [sys.executable, os.path.abspath(__file__), "--relay"], bufsize=0,
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        print("ends:", attend(process, arguments.rover))
    except (KeyboardInterrupt, OSError) as error:
        print("ends:", str(error) or "interrupted")
    process.stdin.close()  # the relay stops the rover then, and says so
    while select.select([process.stdout], [], [], 3)[0]:
        line = process.stdout.readline()
        if not line:
            break
        tell(line)
    process.terminate()  # where the link hangs


if __name__ == "__main__":
    main()
