#!/usr/bin/env bash
# Runs a command as root in a throw-away QEMU machine whose root file system is this machine's (read-only, what is
# written goes to memory), with a Debian kernel that has real SocketCAN and V4L2:
#   vcan0, vcan1 up; /dev/video0, 1: vivid test cameras; /dev/video10, 11: v4l2loopback "left" and "right".
# Usage: test/virtual_machine.sh [--memory MIB] [--timeout S] -- COMMAND...
#        test/virtual_machine.sh --prepare     gets the kernel and builds v4l2loopback into the cache
# Exit status: the command's; 124 timed out, 125 the machine ended without a report, 126 it cannot be made here (the
# reason is on stderr). Files that the command writes to $VM_OUT come back in $VM_OUT. Needs no root outside.
set -euo pipefail
export PATH=$PATH:/sbin:/usr/sbin
memory=2048 limit=600 prepare_only=
while [[ ${1-} == --* ]]; do case $1 in
  --memory) memory=$2; shift 2;; --timeout) limit=$2; shift 2;; --prepare) prepare_only=1; shift;; --) shift; break;;
  *) sed -n '2,9p' "$0" >&2; exit 2;; esac; done
[[ $# -gt 0 || $prepare_only ]] || { sed -n '2,9p' "$0" >&2; exit 2; }

cannot() { echo "no virtual machine here: $*" >&2; exit 126; }
[[ $(uname -m) == x86_64 ]] || cannot "it is made for x86_64"
for tool in qemu-system-x86_64 busybox cpio modprobe depmod make gcc-12 apt-get dpkg; do
  command -v $tool > /dev/null || cannot "$tool is missing (scripts/install_dependencies.sh)"
done
# /tmp and /run are others inside.
cache=${ARFM_VO_VM_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/arfm_vo/virtual_machine}

# The kernel, unpacked beside the system, not installed; and v4l2loopback built for it.
prepare() {
  local new image headers common kbuild version
  depends() { apt-cache depends "$1" 2>/dev/null | sed -n "s/.*Depends: \($2\)\$/\1/p" | head -1; }
  image=$(depends linux-image-amd64 'linux-image-.*')
  [[ $image ]] || cannot "apt knows no linux-image-amd64 (apt-get update)"
  headers=${image/image/headers}
  common=$(depends "$headers" 'linux-headers-.*common')
  kbuild=$(depends "$headers" 'linux-kbuild-.*')
  new=$(mktemp -d "$cache.XXXXXX")
  chmod 755 "$new"
  (cd "$new" && apt-get download -qq "$image" "$headers" "$common" "$kbuild" v4l2loopback-dkms) \
    || { rm -rf "$new"; cannot "the kernel's packages cannot be downloaded"; }
  for package in "$new"/*.deb; do dpkg -x "$package" "$new/root"; rm "$package"; done
  version=${image#linux-image-}
  local tree=$new/root/usr/src/linux-headers-$version
  sed -i "s,/usr/src/,$new/root/usr/src/,g" "$tree/Makefile" "$new/root/usr/src/$common/Makefile"
  cp -r "$new"/root/usr/src/v4l2loopback-* "$new/v4l2loopback"
  make -s -C "$tree" M="$new/v4l2loopback" modules > "$new/make.log" 2>&1 \
    || { tail -20 "$new/make.log" >&2; rm -rf "$new"; cannot "v4l2loopback does not build"; }
  mkdir -p "$new/root/lib/modules/$version/extra"
  cp "$new/v4l2loopback/v4l2loopback.ko" "$new/root/lib/modules/$version/extra/"
  rm -rf "$new/root/usr" "$new/v4l2loopback"
  rm -f "$new/root/lib/modules/$version"/{build,source}
  depmod -b "$new/root" "$version"
  rm -rf "$cache" && mv "$new" "$cache"
}
mkdir -p "$(dirname "$cache")"
[[ -d $cache/root ]] || prepare
[[ $prepare_only && $# -eq 0 ]] && exit 0

version=$(basename "$cache"/root/lib/modules/*)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{initrd/bin,initrd/m,share/out}

# The first root: busybox, the modules that reach the host's files over 9p, and a script.
cp "$(command -v busybox)" "$work/initrd/bin/busybox"
n=100
for module in virtio_pci 9pnet_virtio 9p overlay virtio_console; do
  modprobe -d "$cache/root" -S "$version" --show-depends $module
done | awk '$1 == "insmod" && !seen[$2]++ {print $2}' | while read -r file; do
  n=$((n + 1)); cp "$file" "$work/initrd/m/$n-${file##*/}"
done
cat > "$work/initrd/init" <<'INIT'
#!/bin/busybox sh
b=/bin/busybox
$b mkdir -p /proc /sys /dev /host /rw /new
$b mount -t proc p /proc; $b mount -t devtmpfs d /dev
for k in /m/*; do $b insmod $k; done
o=trans=virtio,version=9p2000.L,msize=512000
$b mount -t 9p -o ro,cache=loose,$o host /host && $b mount -t tmpfs t /rw && $b mkdir /rw/u /rw/w &&
$b mount -t overlay -o lowerdir=/host,upperdir=/rw/u,workdir=/rw/w o /new && $b mkdir -p /new/vm_share &&
$b mount -t 9p -o rw,$o share /new/vm_share || $b poweroff -f
$b mount --move /dev /new/dev; $b umount /proc
exec $b switch_root /new /bin/bash /vm_share/start
INIT
chmod +x "$work/initrd/init"
(cd "$work/initrd" && find . | cpio -o -H newc --quiet > "$work/initrd.cpio")

# The second, on the machine's own files.
cat > "$work/share/start" <<START
mount -t proc p /proc; mount -t sysfs s /sys; mkdir -p /dev/pts /dev/shm; mount -t devpts p /dev/pts
for d in /dev/shm /tmp /run; do mount -t tmpfs -o mode=1777 t \$d; done
ln -sf /proc/self/fd /dev/fd; ip link set lo up; hostname localhost
exec > /dev/kmsg 2>&1
mkdir -p /lib/modules/$version
mount --bind $(printf %q "$cache/root/lib/modules/$version") /lib/modules/$version
modprobe -a vcan vxcan can-raw can-gw
for i in vcan0 vcan1; do ip link add \$i type vcan && ip link set \$i up; done
modprobe vivid n_devs=2 node_types=0x1,0x1 num_inputs=2,2 input_types=0x0c,0x0c vid_cap_nr=0,1
modprobe v4l2loopback devices=2 video_nr=10,11 exclusive_caps=1,1 card_label=left,right
cd $(printf %q "$PWD")
port=\$(basename "\$(dirname "\$(grep -ls ^out /sys/class/virtio-ports/*/name)")")
{ bash /vm_share/command; echo \$? > /vm_share/status; } < /dev/null 2>&1 | cat > /dev/\$port
sync; echo o > /proc/sysrq-trigger; sleep 60
START
{ export -p; echo 'export VM_OUT=/vm_share/out'; printf 'exec'; printf ' %q' "$@"; echo; } > "$work/share/command"

# Hardware virtualisation only where the processor really has it.
accelerator=(-accel "tcg,thread=multi" -cpu max)
grep -qwE 'vmx|svm' /proc/cpuinfo && [[ -w /dev/kvm ]] && accelerator=(-accel kvm -cpu host)
# no_timer_check: on a busy machine the emulated timer's first interrupts are late, and the kernel would end for that.
result=0
timeout -k 5 "$limit" qemu-system-x86_64 -M q35 "${accelerator[@]}" -smp 2 -m "$memory" \
  -nodefaults -no-user-config -no-reboot -display none -monitor none -net none \
  -kernel "$cache/root/boot/vmlinuz-$version" -initrd "$work/initrd.cpio" \
  -append "console=ttyS0 panic=-1 quiet no_timer_check rdinit=/init" -serial "file:$work/console" -device virtio-rng-pci \
  -fsdev local,id=h,path=/,security_model=none,readonly=on,multidevs=remap \
  -device virtio-9p-pci,fsdev=h,mount_tag=host \
  -fsdev local,id=s,path="$work/share",security_model=none -device virtio-9p-pci,fsdev=s,mount_tag=share \
  -device virtio-serial-pci -chardev file,id=o,path=/dev/stdout -device virtserialport,chardev=o,name=out \
  < /dev/null | cat || result=$?
if [[ -n ${VM_OUT-} ]]; then mkdir -p "$VM_OUT" && cp -r "$work/share/out/." "$VM_OUT/"; fi
[[ -s $work/share/status ]] && exit "$(< "$work/share/status")"
[[ -e $work/console ]] && tail -20 "$work/console" >&2
if ((result == 124 || result == 137)); then exit 124; fi
exit 125
