#!/bin/sh
# Puts LinuxCNC's stand-alone interpreter rs274 into .rs274/: the tests' independent reader of LinuxCNC programs.
# Needs Debian 12 and the right to install four small libraries; where that can't be had, the tests that need it are skipped and say so.
set -u
cd "$(dirname "$0")/.." || exit 1
[ -x .rs274/rs274 ] && exit 0
command -v apt-get >/dev/null 2>&1 || { echo "no apt-get: the tests with rs274 will be skipped"; exit 0; }
if [ "$(id -u)" = 0 ]; then as=""
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then as="sudo"
else echo "no right to install packages: the tests with rs274 will be skipped"; exit 0; fi
work=$(mktemp -d) || exit 0
trap 'rm -rf "$work"' EXIT
$as apt-get update -qq
DEBIAN_FRONTEND=noninteractive $as apt-get install -y -qq --no-install-recommends libboost-python1.74.0 libpython3.11 libedit2 libtirpc3 >/dev/null ||
    { echo "rs274's libraries can't be installed: the tests with it will be skipped"; exit 0; }
(cd "$work" && chmod 755 . && apt-get download -qq linuxcnc-uspace >/dev/null 2>&1 && dpkg -x linuxcnc-uspace_*.deb x) ||
    { echo "rs274 can't be downloaded: the tests with it will be skipped"; exit 0; }
mkdir -p .rs274 && cp -a "$work"/x/usr/bin/rs274 "$work"/x/usr/lib/lib*.so* .rs274/
