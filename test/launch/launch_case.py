"""What the tests of launch files share."""
import glob
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import rosbag

BUILD_DIR, SOURCE_DIR = sys.argv[1:3]
FIXTURE = os.path.join(SOURCE_DIR, "rosbag_fixtures", "terrain.bag")
sys.path.insert(0, os.path.join(SOURCE_DIR, "test"))
from ports import find_free_port  # noqa: E402


def end_all_of(uri):
    """Ends what is left of the processes that know this master."""
    for path in glob.glob("/proc/[0-9]*/environ"):
        try:
            with open(path, "rb") as file:
                if f"ROS_MASTER_URI={uri}".encode() in file.read().split(b"\0"):
                    os.kill(int(path.split("/")[2]), signal.SIGKILL)
        except OSError:
            pass  # another's, or it has ended


class LaunchCase(unittest.TestCase):
    """Commands in an empty folder, with a master of their own."""

    def setUp(self):
        self.directory = tempfile.TemporaryDirectory(prefix="arfm_vo_launch_")
        self.folder = self.directory.name

    def tearDown(self):
        self.directory.cleanup()

    def run_command(self, *command, limit_s=100):
        """The exit code and the console of a command, called in the test's folder and ended after a time."""
        uri = f"http://localhost:{find_free_port()}"
        # (To a file: where a required node ends while roslaunch starts others on a busy machine, it leaves its master behind,
        # which would hold a pipe open.)
        with tempfile.TemporaryFile("w+") as console:
            run = subprocess.run(
                ["bash", "-c", '. "$0/devel/setup.bash" && exec timeout -s INT "$@"', BUILD_DIR, str(limit_s), *command],
                env={**os.environ, "PWD": self.folder, "ROS_MASTER_URI": uri}, cwd=self.folder, text=True, stdout=console,
                stderr=subprocess.STDOUT)
            end_all_of(uri)
            console.seek(0)
            return run.returncode, console.read()

    def launch(self, *arguments, limit_s=100, package=("arfm_vo",)):
        return self.run_command("roslaunch", *package, *arguments, limit_s=limit_s)

    def refuse(self, *arguments):
        """What roslaunch says where it refuses to replay."""
        code, console = self.launch("replay.launch", "rviz:=false", *arguments)
        self.assertNotEqual(code, 0, console)
        self.assertNotIn("started with pid", console)
        return console

    def write_bag(self, name, change):
        """The fixture with `change(topic, message)` -> (topic, message) or None applied to all of it."""
        with rosbag.Bag(FIXTURE) as source, rosbag.Bag(os.path.join(self.folder, name), "w") as bag:
            for topic, message, stamp in source.read_messages():
                changed = change(topic, message)
                if changed:
                    bag.write(*changed, stamp)
