#!/usr/bin/python3
"""Installs the build into a folder of its own and uses the package from there alone.

Usage: install_space_test.py BUILD_DIR SOURCE_DIR INSTALL_PREFIX      the prefix that the build is configured for
"""
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(sys.argv[2], "test"))
from ports import find_free_port  # noqa: E402

BUILD_DIR, SOURCE_DIR, INSTALL_PREFIX = sys.argv[1:4]
FIXTURE = os.path.join(SOURCE_DIR, "rosbag_fixtures", "terrain.bag")

# Loads each launch file of the installed package and resolves the program of each node.
CHECK_LAUNCH_FILES = """
import glob, sys
import roslaunch.config, roslaunch.core, roslaunch.node_args
files = sorted(glob.glob(sys.argv[1] + "/launch/*.launch"))
for file in files:
    arguments = ["bag:=" + sys.argv[2], "sequence:=/usr"]
    config = roslaunch.config.load_config_default([(file, arguments)], None, assign_machines=False)
    for node in config.nodes:
        if node.package in ("arfm_vo", "nodelet"):
            machine = roslaunch.core.local_machine()
            program = roslaunch.node_args.create_local_process_args(node, machine)
            print(file, node.name, program[0])
print(len(files), "launch files")
"""


class InstallSpaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="arfm_vo_install_")
        # catkin writes its setup files to the configured prefix, whatever `cmake --install` is told.
        cls.prefix = cls.folder.name + INSTALL_PREFIX
        subprocess.run(["cmake", "--install", BUILD_DIR], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "DESTDIR": cls.folder.name})

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_installed(self, *command):
        """The output of a command in a shell that knows the installed package and no other."""
        environment = {"PATH": "/usr/bin:/bin", "HOME": self.folder.name,
                       "ROS_MASTER_URI": f"http://localhost:{find_free_port()}"}
        run = subprocess.run(
            ["bash", "-c", '. "$0/setup.bash" && exec "$@"', self.prefix, *command],
            env=environment, cwd=self.folder.name, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=200)
        self.assertEqual(run.returncode, 0, f"{command}: {run.stdout}")
        return run.stdout

    def installed(self, *names):
        return os.path.join(self.prefix, *names)

    def test_ros_finds_the_installed_package_and_no_other(self):
        self.assertEqual(self.run_installed("rospack", "find", "arfm_vo").strip(), self.installed("share", "arfm_vo"))

    def test_launch_files_load_and_their_programs_are_installed(self):
        said = self.run_installed("/usr/bin/python3", "-c", CHECK_LAUNCH_FILES, self.installed("share", "arfm_vo"), FIXTURE)
        num_files = sum(name.endswith(".launch") for name in os.listdir(os.path.join(SOURCE_DIR, "launch")))
        self.assertIn(f"{num_files} launch files", said)
        self.assertIn(self.installed("lib", "arfm_vo", "pose_node"), said)
        self.assertNotIn(BUILD_DIR, said)

    def test_scripts_configuration_and_headers_are_installed(self):
        for name in ("share/arfm_vo/config/arfm.yaml", "share/arfm_vo/config/odometry.rviz",
                     "share/arfm_vo/urdf/rover.urdf", "include/arfm_vo/geometry/rigid3.h",
                     "include/arfm_vo/OdometryStatus.h", "lib/arfm_vo/drive_to.py",
                     "lib/arfm_vo/operator_answer.py"):
            self.assertTrue(os.path.exists(self.installed(*name.split("/"))), name)
        self.run_installed("/usr/bin/python3", "-c", "import arfm_vo.msg; arfm_vo.msg.DriveStatus()")

    def test_another_package_compiles_and_links_against_it(self):
        build = os.path.join(self.folder.name, "downstream")
        self.run_installed("cmake", "-S", os.path.join(SOURCE_DIR, "test/install/downstream"), "-B", build)
        self.run_installed("cmake", "--build", build)
        self.assertEqual(self.run_installed(os.path.join(build, "downstream")), "1 m\n")

    def test_a_replay_through_the_installed_nodelets_saves_the_trajectory(self):
        output = os.path.join(self.folder.name, "output")
        said = self.run_installed("roslaunch", "arfm_vo", "replay.launch", "bag:=" + FIXTURE,
                                  "rviz:=false", "nodelets:=true", "trajectory_dir:=" + output)
        with open(os.path.join(output, "trajectory.tum")) as file:
            self.assertGreater(len(file.readlines()), 20, said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
