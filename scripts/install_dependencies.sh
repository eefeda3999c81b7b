#!/usr/bin/env bash
# Installs everything that arfm_vo needs to build, test and run, from Debian's own packages (reference: Debian 12).
# Usage: scripts/install_dependencies.sh [--checks]      as root, or as a user who may use sudo
#        --checks   also what scripts/static_checks.sh needs
#        --list GROUP ...   installs nothing, prints the packages of build, ros, libraries, tests, runtime, hardware
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }

build=(g++ cmake ninja-build make pkg-config git ca-certificates catkin)
# (libstereo-image-proc-dev and libimage-proc-dev hold the package.xml and nodelet lists that roslaunch needs.)
# libX-msgs-dev holds the headers, ros-X-msgs the .msg files; both are needed.
ros=(libroscpp-dev ros-message-generation ros-message-runtime
     libstd-msgs-dev ros-std-msgs libstd-srvs-dev ros-std-srvs libsensor-msgs-dev ros-sensor-msgs
     libnav-msgs-dev ros-nav-msgs libgeometry-msgs-dev ros-geometry-msgs
     libdiagnostic-msgs-dev ros-diagnostic-msgs libvisualization-msgs-dev ros-visualization-msgs
     libinteractive-markers-dev libactionlib-dev libmove-base-msgs-dev ros-move-base-msgs
     libimage-transport-dev libcamera-info-manager-dev libcv-bridge-dev
     libtf2-ros-dev libtf2-geometry-msgs-dev libtf2-eigen-dev
     libnodelet-dev libnodeletlib-dev pluginlib-dev
     libdynamic-reconfigure-config-init-mutex-dev python3-dynamic-reconfigure
     libdiagnostic-updater-dev librosbag-dev librosbag-storage-dev)
libraries=(libopencv-dev libceres-dev libeigen3-dev libyaml-cpp-dev libpng-dev libboost-program-options-dev)
tests=(librostest-dev libgtest-dev libgmock-dev libbenchmark-dev libdlib-dev)
runtime=(python3-roslaunch python3-rostest python3-rosnode python3-rosservice python3-rostopic rosbash libnodeletlib-tools tf2-tools
         python3-rosbag python3-rospy python3-geometry-msgs python3-nav-msgs python3-std-srvs
         python3-diagnostic-msgs python3-cv-bridge python3-opencv rviz ros-image-view
         ros-stereo-image-proc libstereo-image-proc-dev libimage-proc-dev ros-robot-state-publisher
         ros-camera-calibration python3-image-geometry python3-actionlib python3-move-base-msgs
         xvfb xauth imagemagick gnuplot-nox python3-matplotlib python3-numpy hostname procps)
# A small virtual machine for real SocketCAN and V4L2 where the kernel has neither.
hardware=(can-utils v4l-utils qemu-system-x86 busybox-static cpio kmod iproute2 nftables)
checks=(shellcheck pyflakes3 cppcheck clang clang-tidy libclang-rt-dev)

if [[ ${1-} == --list ]]; then
  for group in "${@:2}"; do
    declare -n listed=$group
    printf '%s\n' "${listed[@]}"
  done
  exit
fi

as_root() { if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi; }

packages=("${build[@]}" "${ros[@]}" "${libraries[@]}" "${tests[@]}" "${runtime[@]}" "${hardware[@]}")
[[ ${1-} == --checks ]] && packages+=("${checks[@]}")
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}"
fi
# Debian 11 describes the nodelets of stereo_image_proc (rectify:=true) as in /usr/lib, where they are not; pluginlib looks
# here too.
plugins=/usr/lib/$(gcc -dumpmachine)/ros
for name in image_proc stereo_image_proc; do
  if grep -qs '"lib/lib' /usr/share/$name/nodelet_plugins.xml && [ ! -e "$plugins/lib$name.so" ]; then
    as_root ln -sv "../lib$name.so" "$plugins/"
  fi
done
# roslaunch and rostest need localhost and the machine's own name to resolve; a bare chroot has no such lines.
grep -qw localhost /etc/hosts 2>/dev/null || echo '127.0.0.1 localhost' | as_root tee -a /etc/hosts >/dev/null
getent hosts "$(hostname)" >/dev/null || echo "127.0.1.1 $(hostname)" | as_root tee -a /etc/hosts >/dev/null ||
  echo "install_dependencies: the name $(hostname) does not resolve and /etc/hosts cannot be written: roslaunch may stop" >&2
echo "install_dependencies: ${#packages[@]} packages present, ${#missing[@]} newly installed"
