#!/bin/sh
# Tries an installer in a clean Debian of this machine's release, in a folder that is its root: sh installer/trial.sh FILE DIR
# FILE is a .deb, which is installed and removed again, or an AppImage or the archive of its folder, which is only started.
# Each time it prints the version, programs the sample part and draws the window without a screen, as a user without rights.
# Needs root, debootstrap and 6 GB at DIR, which stays for a look at what was made: out/ in the home of the user "miller".
set -eu

[ $# = 2 ] && [ -f "$1" ] || { echo "usage: sh installer/trial.sh FILE DIR" >&2; exit 2; }
[ "$(id -u)" = 0 ] || { echo "trial.sh: only root may change the root of a process" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
file=$(realpath "$1")
root=$2
. /etc/os-release

[ -e "$root/etc/debian_version" ] || debootstrap --variant=minbase "$VERSION_CODENAME" "$root" >/dev/null
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LANG=C.UTF-8 "$@"; }
as_user() { inside su miller -c "cd && $1"; }
inside id miller >/dev/null 2>&1 || inside useradd --create-home miller
mount -t proc proc "$root/proc"
mount -t tmpfs tmpfs "$root/dev/shm"
mount -t devpts devpts "$root/dev/pts"
trap 'umount "$root/dev/pts" "$root/dev/shm" "$root/proc"' EXIT
files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./tmp \) -prune -o -print | sort); }

# What a package brings of its own is told from what Debian's brought for it.
case "$file" in
*.deb)
    cp "$file" "$root/tmp/trunnion.deb"
    inside apt-get update -qq
    inside apt-get install -y -qq --no-install-recommends $(dpkg-deb -f "$file" Depends | tr -d ,) >/dev/null
    files >"$root.before"
    inside apt-get install -y --no-install-recommends /tmp/trunnion.deb | tail -n 8
    cli=trunnion python=trunnion-python
    ;;
*)
    inside apt-get update -qq
    inside apt-get install -y -qq --no-install-recommends $(sh "$here/debian.sh" --names drawing) >/dev/null
    rm -rf "$root/opt/trial" && mkdir -p "$root/opt/trial"
    case "$file" in
    *.tar.zst)
        tar -C "$root/opt/trial" --zstd -xf "$file"
        start=/opt/trial/Trunnion.AppDir/AppRun ;;
    *)
        cp "$file" "$root/opt/trial/Trunnion.AppImage"
        chmod 755 "$root/opt/trial/Trunnion.AppImage"
        start="/opt/trial/Trunnion.AppImage --appimage-extract-and-run" ;;
    esac
    inside sh -c '! command -v python3' || { echo "trial.sh: $root is not clean, it has a Python" >&2; exit 1; }
    cli="$start" python="$start python"
    ;;
esac

cp "$here/trial_window.py" "$root/tmp/trial_window.py"
as_user "$cli --version"
as_user "$python -P -m trunnion_resources B1 > sample && $cli program \$(cat sample) -o out --name B1"
as_user "ls -l out"
as_user "QT_QPA_PLATFORM=offscreen $python -P /tmp/trial_window.py \$(cat sample) out/window.png && ls -l out/window.png"

case "$file" in
*.deb)
    inside apt-get remove -y -qq trunnion | tail -n 3
    inside apt-get purge -y -qq trunnion >/dev/null
    files >"$root.after"
    echo "What came since the package was installed and is still there:"
    diff "$root.before" "$root.after" | sed -n 's/^> //p' | grep -v "^./home/miller/out/" | cut -d/ -f1-5 | sort | uniq -c || true
    ;;
esac
