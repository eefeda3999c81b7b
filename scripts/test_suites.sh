#!/usr/bin/env bash
# Builds the package and runs its tests on other systems, each in a chroot of its own (debootstrap), as root.
# Usage: scripts/test_suites.sh [--core] [SUITE ...]      default: all
#   bullseye, bookworm, trixie   Debian 11, 12, 13
#   bullseye-gcc9                Debian 11 by g++ 9
#   arm64                        this machine's release for arm64: the layers below ros, cross-built, their tests in qemu-user
#   --core                       only the layers below ros and their tests, which need no ROS master
# Each ends with a line "SUITE: ... tests". The chroots (4 GB each) stay in ARFM_VO_SUITES (default: ~/.cache/arfm_vo/suites);
# the packages come from where this machine's apt has them.
set -euo pipefail
[[ ${1-} != @(-h|--help) ]] || { sed -n '1d; /^#/!q; s/^# \{0,1\}//p' "$0"; exit; }
cd "$(dirname "$0")/.."
suites=${ARFM_VO_SUITES:-${XDG_CACHE_HOME:-$HOME/.cache}/arfm_vo/suites}
mkdir -p "$suites"
suites=$(cd "$suites" && pwd)
shared=${ARFM_VO_SHARED:-../shared}  # the tests' real recordings, where they are
fail() { echo "test_suites: $*" >&2; exit 1; }
[ "$(id -u)" -eq 0 ] || fail "a chroot can be made by root only"
is_core=
if [[ ${1-} == --core ]]; then is_core=1; shift; fi
core=(base geometry image features matching reconstruction pose mapping tracking bundle_adjustment odometry configuration
      calibration datasets evaluation driving hardware simulation rehearsal)

need() { command -v "$1" > /dev/null || fail "$1 is missing (package $2)"; }

debian_mirror() {
  # shellcheck disable=SC2016  # apt's own
  apt-get indextargets --format '$(REPO_URI)' 'Origin: Debian' 'Label: Debian' | sed -n 1p | grep . ||
    fail "this machine's apt knows no mirror of Debian"
}

# make_chroot NAME: the bare system.
make_chroot() {
  [ -d "$suites/$1" ] && return
  need debootstrap debootstrap
  local mirror
  mirror=$(debian_mirror)
  rm -rf "$suites/$1.new"
  debootstrap --variant=minbase "$1" "$suites/$1.new" "$mirror" > "$suites/$1.log" 2>&1 ||
    fail "debootstrap failed: $suites/$1.log"
  mv "$suites/$1.new" "$suites/$1"
}

# enter NETWORK CHROOT COMMAND...: NETWORK is the host's (online) or one of its own (offline), where ports are free.
enter() {
  local spaces=(--mount --pid --fork --kill-child)
  [ "$1" = offline ] && spaces+=(--net)
  # shellcheck disable=SC2016  # for the shell inside
  unshare "${spaces[@]}" bash -c '
    root=$1; shift
    mount -t proc proc "$root/proc"; mount --rbind /dev "$root/dev"; mount --rbind /sys "$root/sys"
    ip link set lo up
    exec chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 "$@"' -- "${@:2}"
}

# put_sources FOLDER: the files of this package, without what was built; older ones go, but for a build folder's.
put_sources() {
  mkdir -p "$1"
  find "$1" -mindepth 1 -maxdepth 1 ! -name '_*' -exec rm -rf {} +
  git ls-files -z --cached --others --exclude-standard | tar -c --null -T - --ignore-failed-read | tar -x -C "$1"
}

# report SUITE BUILD: the numbers of gtest and rostest cases that ran.
report() { echo "$1: $(catkin_test_results "$2/test_results" | tail -n 1)"; }

# test_chroot SUITE: in the chroot of its release, in a folder of its own.
test_chroot() {
  local release=${1%-gcc9} status=0 compiler=()
  local root=$suites/$release folder=root/arfm_vo${1#"${1%-gcc9}"}
  make_chroot "$release"
  cp /etc/resolv.conf "$root/etc/"
  put_sources "$root/$folder"
  [ ! -d "$shared" ] || cp -RLup "$shared/." "$root/root/shared"
  enter online "$root" "/$folder/scripts/install_dependencies.sh"
  if [ "$1" != "$release" ]; then
    enter online "$root" apt-get install -y -qq --no-install-recommends g++-9
    compiler=(CXX=g++-9)
  fi
  rm -rf "$root/$folder/_b/test_results"
  if [[ $is_core ]]; then
    enter offline "$root" "${compiler[@]}" "/$folder/scripts/build.sh" "${core[@]/#/test_}"
    enter offline "$root" bash -c "cd /$folder/_b && ctest --output-on-failure -R '_gtest_test_($(IFS='|'; echo "${core[*]}"))\$'" || status=1
  else
    enter offline "$root" "${compiler[@]}" "/$folder/scripts/test.sh" --full || status=1
  fi
  report "$1" "$root/$folder/_b"
  return $status
}

# make_sysroot: the packages for arm64, unpacked only. None of their scripts runs, so that the kernel need not know arm64.
make_sysroot() {
  local root=$suites/arm64 lib=usr/lib/aarch64-linux-gnu packages file link
  [ -d "$root" ] && return
  need mmdebstrap mmdebstrap
  mapfile -t packages < <(scripts/install_dependencies.sh --list ros libraries tests)
  packages+=(catkin libc6-dev "libstdc++-$(aarch64-linux-gnu-g++ -dumpversion)-dev")
  rm -rf "$root.new"
  mmdebstrap --variant=extract --arch=arm64 --include="$(IFS=,; echo "${packages[*]}")" \
    "$(. /etc/os-release; echo "$VERSION_CODENAME")" "$root.new" "$(debian_mirror)" > "$root.log" 2>&1 ||
    fail "mmdebstrap failed: $root.log"
  # Then what their scripts would do, and absolute paths as they are seen from outside.
  for file in "$root.new/$lib"/{atlas,blas,lapack}/*; do
    [ ! -e "$file" ] || [ -e "$root.new/$lib/${file##*/}" ] || ln -s "${file#"$root.new/$lib/"}" "$root.new/$lib/"
  done
  find "$root.new/usr" -type l -lname '/*' | while read -r link; do
    ln -snf "$(realpath -ms --relative-to="$(dirname "$link")" "$root.new$(readlink "$link")")" "$link"
  done
  sed -i "s,\([;\"]\)/$lib,\1$root/$lib,g" "$root.new/$lib/cmake/Ceres/CeresTargets.cmake"
  rm -rf "$root.new/dev"  # qemu would take its ptmx for the machine's
  mv "$root.new" "$root"
}

# compare_trajectories SYSROOT PROGRAM: that a program for arm64 goes the same way as this machine's, to 0.01 % of it.
compare_trajectories() {
  local here=${BUILD_DIR:-_b}/devel/lib/arfm_vo/kitti_odometry folder=$shared/data/kitti/odometry_06_000-050 work
  if [ ! -x "$here" ] || [ ! -d "$folder" ]; then
    echo "arm64: no trajectory compared: it needs $here and $folder"
    return
  fi
  work=$(mktemp -d)
  "$here" "$folder" --output "$work/here" > /dev/null
  qemu-aarch64-static -L "$1" "$2" "$folder" --output "$work/arm64" > /dev/null
  python3 - "$work" << 'PYTHON' || { rm -rf "$work"; return 1; }
import math, sys
here, arm64 = ([[float(line.split()[i]) for i in (3, 7, 11)] for line in open(f'{sys.argv[1]}/{name}/poses_online.txt')]
               for name in ('here', 'arm64'))
way = sum(map(math.dist, here, here[1:]))
apart = max(map(math.dist, here, arm64))
print(f'arm64: {len(arm64)} live poses, at most {100 * apart / way:.2g} % of the way from those of this machine')
sys.exit(len(here) != len(arm64) or apart > 1e-4 * way)
PYTHON
  rm -rf "$work"
}

test_arm64() {
  need aarch64-linux-gnu-g++ g++-aarch64-linux-gnu
  need qemu-aarch64-static qemu-user-static
  local root=$suites/arm64 source=$suites/build_arm64/arfm_vo layer status=0
  make_sysroot
  put_sources "$source"  # (not below a name that begins with $root: CMake takes that off run paths)
  cat > "$root.cmake" << CMAKE
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_SYSROOT $root)
set(CMAKE_FIND_ROOT_PATH $root)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)  # files of the build folder too
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(roslaunch_DIR /usr/share/roslaunch/cmake)
CMAKE
  rm -rf "$source/_b/test_results"
  CMAKE_TOOLCHAIN_FILE=$root.cmake CMAKE_PREFIX_PATH=/usr PKG_CONFIG_SYSROOT_DIR=$root \
    PKG_CONFIG_LIBDIR=$root/usr/lib/aarch64-linux-gnu/pkgconfig:$root/usr/share/pkgconfig \
    "$source/scripts/build.sh" "${core[@]/#/test_}" kitti_odometry
  for layer in "${core[@]}"; do
    qemu-aarch64-static -L "$root" "$source/_b/devel/lib/arfm_vo/test_$layer" \
      --gtest_brief=1 --gtest_output="xml:$source/_b/test_results/test_$layer.xml" || status=1
  done
  compare_trajectories "$root" "$source/_b/devel/lib/arfm_vo/kitti_odometry" || status=1
  report arm64 "$source/_b"
  return $status
}

chosen=("$@")
[ $# -gt 0 ] || chosen=(bullseye bullseye-gcc9 bookworm trixie arm64)
case ${#chosen[@]}-${chosen[0]} in
  1-arm64) test_arm64 ;;
  1-bullseye | 1-bullseye-gcc9 | 1-bookworm | 1-trixie) test_chroot "${chosen[0]}" ;;
  1-*) fail "'${chosen[0]}' is none of bullseye bullseye-gcc9 bookworm trixie arm64" ;;
  *)
    result=0
    for suite in "${chosen[@]}"; do
      echo "== $suite"
      scripts/test_suites.sh ${is_core:+--core} "$suite" || result=1
    done
    exit $result
    ;;
esac
