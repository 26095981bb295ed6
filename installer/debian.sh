#!/bin/sh
# Installs the Debian packages that Trunnion needs where it may (as root, or by sudo without a password), and names those that
# are missing where it may not: for the core, for drawing, and for a window on an X server (Qt's xcb plugin does not bring its
# libraries). With --display also the virtual screen for a second run of the window's tests. With --names core, drawing or window it
# only prints that group's packages: the installers read them here.
set -u

core="python3-venv libgomp1"
drawing="libegl1 libgl1 libfontconfig1 libfreetype6 libdbus-1-3 libglib2.0-0 libxkbcommon0 libx11-6 fonts-dejavu-core"
window="libxcb-cursor0 libxcb-icccm4 libxcb-image0 libxcb-keysyms1 libxcb-randr0 libxcb-render-util0 libxcb-render0 libxcb-shape0 libxcb-shm0 libxcb-sync1 libxcb-xfixes0 libxcb-xkb1 libx11-xcb1 libxkbcommon-x11-0"
needed="$core $drawing $window"
if [ "${1:-}" = "--names" ]; then
    case "${2:-}" in
        core) echo "$core" ;;
        drawing) echo "$drawing" ;;
        window) echo "$window" ;;
        *) echo "debian.sh: --names wants core, drawing or window" >&2; exit 2 ;;
    esac
    exit 0
fi
[ "${1:-}" = "--display" ] && needed="$needed xvfb xauth"

command -v dpkg-query >/dev/null 2>&1 || { echo "This is not Debian: make sure you have the equivalents of: $needed"; exit 0; }

missing=""
for package in $needed; do
    [ "$package" = python3-venv ] && python3 -c "import ensurepip" 2>/dev/null && continue
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q "ok installed" || missing="$missing $package"
done
[ -z "$missing" ] && exit 0

if [ "$(id -u)" = 0 ]; then as=""
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then as="sudo"
else
    echo "These Debian packages are missing and can't be installed without root:$missing"
    echo "Ask an administrator for: apt-get install --no-install-recommends$missing"
    exit 0
fi
echo "Installing Debian packages:$missing"
$as apt-get update -qq && DEBIAN_FRONTEND=noninteractive $as apt-get install -y -qq --no-install-recommends $missing >/dev/null
