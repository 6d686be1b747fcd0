#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Packages the build for Debian and for Python, and lives with the packages, each on a bare Debian 12
# that debootstrap makes. The wheel: installs it with pip, meshes from Python and by the command line,
# uninstalls it. Debian's: installs them with apt, boots the machine with its own systemd in
# namespaces of its own, meshes through the service, by the command line and from Python, reads the
# manual, upgrades, and removes and purges them. Needs root, for all of that.
#
#   tests/package.sh BUILD PORTABLE     folders that were built by the presets release and portable
#
# Fails if a package does not install, the service does not run confined as its user, a mesh is
# wrong, a job is lost, or anything of weft is left after uninstalling or purging.
set -euo pipefail
build=$(realpath "${1:?usage: tests/package.sh BUILD PORTABLE}")
portable=$(realpath "${2:?usage: tests/package.sh BUILD PORTABLE}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
((EUID == 0)) || {
  echo "package.sh: needs root, for debootstrap and systemd" >&2
  exit 1
}

scratch=$(mktemp -d)
root=$scratch/root
# systemd makes groups of its own below that in which it starts; they go with it.
group=$(findmnt -nt cgroup2 -o TARGET | head -n 1)/weft-package.$$
machine=
tidy_up() {
  [[ -z $machine ]] || kill -KILL "$machine" 2>/dev/null || true
  wait
  [[ ! -d $group ]] || find "$group" -depth -type d -exec rmdir {} + || true
  rm -rf --one-file-system "$scratch"
}
trap tidy_up EXIT

say() { printf '==> %s (at %d s)\n' "$*" $SECONDS; }
fail() {
  printf 'package.sh: %s\n' "$*" >&2
  exit 1
}
# Waits half a minute for a command to succeed.
until_true() {
  local tries
  for ((tries = 0; tries < 600; ++tries)); do
    "$@" && return
    sleep 0.05
  done
  return 1
}

# Becomes the systemd of $1, as the first process of namespaces of its own.
boot() {
  set -e
  mount --make-rprivate /
  mount --bind "$1" "$1"
  cd "$1"
  mount -t proc proc proc
  mount -t sysfs sysfs sys
  mount -t cgroup2 cgroup2 sys/fs/cgroup
  mount -t tmpfs tmpfs run
  mount -t tmpfs tmpfs dev
  local device
  for device in null zero full random urandom tty; do
    touch "dev/$device"
    mount --bind "/dev/$device" "dev/$device"
  done
  ln -s /proc/self/fd dev/fd
  ln -s pts/ptmx dev/ptmx
  mkdir dev/pts dev/shm
  mount -t devpts -o newinstance,ptmxmode=0666 devpts dev/pts
  mount -t tmpfs tmpfs dev/shm
  ip link set lo up
  mkdir host
  pivot_root . host
  # shellcheck disable=SC2093
  exec env -i container=weft PATH=/usr/sbin:/usr/bin:/sbin:/bin sh -c \
    'umount -l /host && rmdir /host && exec /lib/systemd/systemd --unit=multi-user.target'
}
start_machine() {
  mkdir "$group"
  bash -c 'echo $$ >"$1/cgroup.procs"; shift; exec "$@"' bash "$group" \
    unshare --mount --pid --fork --kill-child --net --uts --ipc --cgroup \
    bash -c "$(declare -f boot); boot $root" >"$scratch/boot.log" 2>&1 &
  local outside=$!
  until_true pgrep -P "$outside" >/dev/null || fail "nothing boots: $(<"$scratch/boot.log")"
  machine=$(pgrep -P "$outside")
}
inside() {
  nsenter --target "$machine" --all -- env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
    LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}
runs() { inside systemctl is-active --quiet weftd 2>/dev/null; }
serves() { [[ $(inside weft health --server 127.0.0.1:7421 2>/dev/null) == serving ]]; }
shows_the_journal() { inside journalctl --no-pager --unit weftd --lines 20; }
# Of all that it shows: a grep that ends early would end journalctl by SIGPIPE.
journal_says() { grep -q "$1" <<<"$(shows_the_journal)"; }
before_boot() { tests/inside.sh "$root" "$@"; }

say "packages, by cpack"
(cd "$scratch" && cpack --config "$build/CPackConfig.cmake" -B "$scratch/packages") \
  >"$scratch/cpack.log" 2>&1 || fail "cpack failed: $(tail "$scratch/cpack.log")"
(cd "$scratch/packages" && du --apparent-size --block-size=1000 ./*.deb)

say "packages for Python, twice"
export SOURCE_DATE_EPOCH=1000000000
/usr/bin/python3 -B deploy/package/wheels.py "$portable" "$scratch/wheels"
/usr/bin/python3 -B deploy/package/wheels.py "$portable" "$scratch/again"
diff -r "$scratch/wheels" "$scratch/again" || fail "the same build gives other packages for Python"
(cd "$scratch/wheels" && du --apparent-size --block-size=1000 ./*)

say "a bare Debian 12, by debootstrap"
debootstrap --variant=minbase bookworm "$root" >"$scratch/debootstrap.log" 2>&1 ||
  fail "debootstrap failed: $(tail -n 3 "$scratch/debootstrap.log")"
cp /etc/resolv.conf "$root/etc/"
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/test"
cp tests/models/pipe.poly "$root/srv"
mesh=(/srv/pipe.poly --size '0.4*hypot(x-200, y-200) + 1')

say "the wheel's programs, beside nothing but a bare Debian 12"
other=$scratch/other
cp -a "$root" "$other"
in_other() { tests/inside.sh "$other" "$@"; }
/usr/bin/python3 -m pip install --quiet --root-user-action ignore --no-index --no-deps \
  --target "$other/opt" "$scratch"/wheels/*manylinux*.whl
in_other /opt/weft/carried/bin/weft mesh "${mesh[@]}" -o /srv/bare.vtu --draw /srv/bare.png --quiet
in_other /opt/weft/carried/bin/weft check /srv/bare.vtu --domain "${mesh[@]}" >/dev/null
rm -rf "$other"/opt/*
printf 'meshes:\n  - {name: pipe, input: pipe.poly, size: 4, output: pipe.vtu}\n' >"$other/srv/meshes.yaml"
(
  cd "$other/srv"
  PATH=/usr/bin:/bin WEFT_WHEEL=$(echo "$scratch"/wheels/*manylinux*.whl) "$OLDPWD/deploy/ci/mesh.sh" meshes.yaml
) >"$scratch/mesh.log" 2>&1 || fail "no pipeline meshes with the wheel: $(tail "$scratch/mesh.log")"
[[ -s $other/srv/pipe.vtu && -s $other/srv/weft-reports/weft-junit.xml ]] || fail "the pipeline left no mesh"

say "pip install"
# The packages of Python that it needs are Debian's: pip needs no index here.
{
  in_other apt-get update -qq &&
    in_other apt-get install -y -qq --no-install-recommends \
      python3-pip python3-grpcio python3-protobuf python3-numpy
} >"$scratch/apt.log" 2>&1 || fail "pip does not install: $(tail "$scratch/apt.log")"
files_but_caches() {
  (cd "$other" && find . -xdev '(' -path ./srv -o -path ./tmp -o -name __pycache__ ')' -prune -o \
    -print | LC_ALL=C sort)
}
files_but_caches >"$scratch/before"
cp "$scratch"/wheels/*.whl "$other/srv"
in_other sh -c 'pip install --quiet --no-index --break-system-packages --root-user-action ignore \
  /srv/*manylinux*.whl' || fail "the wheel does not install"
cat >"$other/srv/mesh.py" <<'END'
import weft
with weft.local() as client:
    mesh = client.mesh("/srv/pipe.poly", size="0.4*hypot(x-200, y-200) + 1")
mesh.write("/tmp/python.vtu")
assert weft.mesh("/srv/pipe.poly", size="0.4*hypot(x-200, y-200) + 1").digest == mesh.digest
END
as_nobody=(setpriv --reuid 65534 --regid 65534 --clear-groups)
in_other "${as_nobody[@]}" python3 /srv/mesh.py
in_other weft check /tmp/python.vtu --domain "${mesh[@]}" >/dev/null
in_other "${as_nobody[@]}" python3 -m weft mesh "${mesh[@]}" -o /tmp/module.vtu --quiet
in_other cmp /srv/bare.vtu /tmp/module.vtu
[[ $(in_other weftd --version) == $(in_other weft --version | sed 's/^weft /weftd /') ]] ||
  fail "the wheel's programs have two versions"
in_other sh -c 'pip uninstall --quiet --yes --break-system-packages --root-user-action ignore weftmesh'
left=$(files_but_caches | LC_ALL=C comm -13 "$scratch/before" -)
[[ -z $left ]] || fail "left after pip uninstall: $left"
rm -rf --one-file-system "$other"

mkdir "$root/srv/packages"
mv "$scratch"/packages/*.deb "$root/srv/packages"

say "apt-get install"
{
  before_boot apt-get update -qq &&
    before_boot sh -c 'apt-get install -y -qq --no-install-recommends man-db /srv/packages/*.deb'
} >"$scratch/apt.log" 2>&1 || fail "the packages do not install: $(tail "$scratch/apt.log")"

say "boot"
start_machine
until_true runs || fail "weftd does not run: $(cat "$scratch/boot.log"; shows_the_journal)"
until_true serves || fail "weftd does not serve: $(shows_the_journal)"
pid=$(inside systemctl show --property MainPID --value weftd)
user=$(inside id -u weftd)
confined=$(inside cat "/proc/$pid/status" | tr -s '\t' ' ')
for line in "Uid: $user $user $user $user" "NoNewPrivs: 1" "Seccomp: 2" "CapBnd: 0000000000000000"; do
  grep -qxF "$line" <<<"$confined" || fail "the service is not confined: no '$line'"
done

say "meshes through the service, of its own server, and from Python, also by the library"
inside weft mesh "${mesh[@]}" -o /srv/pipe.vtu --draw /srv/pipe.png --server 127.0.0.1:7421 --quiet
inside weft check /srv/pipe.vtu --domain "${mesh[@]}"
inside weft mesh "${mesh[@]}" -o /srv/own.vtu --quiet
inside cmp /srv/pipe.vtu /srv/own.vtu
inside python3 -c "import weft
with weft.Client('127.0.0.1:7421') as client:
    mesh = client.mesh('/srv/pipe.poly', size='0.4*hypot(x-200, y-200) + 1')
print(mesh.quality())
assert weft.mesh('/srv/pipe.poly', size='0.4*hypot(x-200, y-200) + 1').digest == mesh.digest"
protocol=$(PKG_CONFIG_LIBDIR=$root/usr/share/pkgconfig pkg-config --variable=protodir weft-protocol)
protoc -I "$protocol" -o /dev/null weft/v1/mesh_service.proto weft/v1/job_service.proto
job=$(inside weft submit "${mesh[@]}" --wait --server 127.0.0.1:7421 --quiet)
for page in weft weft-mesh weftd; do
  # Of pages at an unusual width man keeps no copy of its own.
  inside sh -c "MANWIDTH=90 man $page | grep -qw SYNOPSIS" || fail "there is no manual of $page"
done

say "an upgrade, over changed variables"
inside sed -i 's/^#WEFT_DRAIN=.*/WEFT_DRAIN=29/' /etc/default/weftd
inside sh -c 'dpkg --install /srv/packages/weftd_*.deb' >"$scratch/upgrade.log" 2>&1 ||
  fail "the upgrade fails: $(<"$scratch/upgrade.log")"
until_true serves || fail "weftd does not serve after an upgrade: $(shows_the_journal)"
[[ $(inside systemctl show --property MainPID --value weftd) != "$pid" ]] ||
  fail "the upgrade did not restart the service"
until_true journal_says 'event=draining.*seconds=30' ||
  fail "the service was not drained: $(shows_the_journal)"
inside weft fetch "$job" -o /srv/fetched.vtu --server 127.0.0.1:7421 --quiet
inside cmp /srv/pipe.vtu /srv/fetched.vtu || fail "the fetched mesh is another one"
inside systemctl stop weftd
[[ $(inside systemctl show --property Result --value weftd) == success ]] ||
  fail "the service did not stop by itself: $(shows_the_journal)"
until_true journal_says 'event=draining.*seconds=29' || fail "WEFT_DRAIN was not read"
inside systemctl start weftd

say "remove, and purge"
inside apt-get remove -y -qq weft weftd python3-weft libweft0 libweft-dev weft-protocol-dev \
  >"$scratch/remove.log" 2>&1 ||
  fail "removing fails: $(<"$scratch/remove.log")"
! runs || fail "the service of a removed package runs"
inside test -d /var/lib/weftd -a -f /etc/default/weftd || fail "removing deletes what is kept"
inside apt-get purge -y -qq weftd libweft0 >"$scratch/purge.log" 2>&1 ||
  fail "purging fails: $(<"$scratch/purge.log")"
left=$(inside find / -xdev -path /srv -prune -o -iname '*weft*' -print)
[[ -z $left ]] || fail "left after purging: $left"
! inside grep weft /etc/passwd /etc/group /etc/shadow || fail "the user is left after purging"
left=$(inside find / -xdev '(' -nouser -o -nogroup ')')
[[ -z $left ]] || fail "left after purging, of no user: $left"
