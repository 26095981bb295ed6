"""Makes the AppImage from the wheel: `python -m installer.appimage WHEEL --runtime RUNTIME`.

An AppImage of type 2 is the runtime of the AppImage project, which mounts what follows it, and the folder Trunnion.AppDir as squashfs.
Without the runtime, the folder is packed as an archive, which is no AppImage: unpacked anywhere, its AppRun starts the program.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
from pathlib import Path

from installer import environment, files
from installer.appimage.interpreter import (
    FROM_HOST,
    copy_interpreter,
    copy_libraries,
    libraries,
    library_path,
)
from installer.project import ROOT, build_name, given_wheel, project, source_date, stop

HERE = Path(__file__).resolve().parent
FOLDER = "Trunnion.AppDir"
MAGIC = b"AI\x02"
"""What an ELF file of type 2 has at byte 8 (AppImage specification, type 2)."""


def main(arguments: list[str] | None = None) -> int:
    """Make the AppImage, or the archive, and return the exit code."""
    options = _options(arguments)
    wheel, seconds = given_wheel(options.wheel), source_date()
    runtime = checked_runtime(options.runtime) if options.runtime else None
    app = files.empty_folder(ROOT / "build" / "appimage") / FOLDER
    fill(app, wheel, options.python)
    files.with_one_time(app, seconds)
    name = f"Trunnion-{project()['version']}-{os.uname().machine}"
    target = Path(options.output).resolve() / name
    target.parent.mkdir(parents=True, exist_ok=True)
    if runtime is None:
        print(archive(app, target.with_name(f"{name}.AppDir.tar.zst"), seconds))
    else:
        print(image(app, runtime, target.with_name(f"{name}.AppImage"), seconds))
    return 0


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m installer.appimage", description=__doc__)
    parser.add_argument("wheel", metavar="WHEEL", help="the wheel, as `make wheel` makes it")
    parser.add_argument("-o", "--output", default="dist", metavar="DIR", help="where it goes")
    parser.add_argument("--python", default="/usr/bin/python3", help="the interpreter to copy")
    parser.add_argument("--runtime", metavar="FILE", help="the AppImage project's runtime, type 2")
    return parser.parse_args(arguments)


def checked_runtime(word: str) -> bytes:
    """Return the bytes of the runtime; stops where the file is none."""
    path = Path(word)
    content = path.read_bytes() if path.is_file() else b""
    if content[:4] != b"\x7fELF" or content[8:11] != MAGIC:
        stop(f"{path} is no AppImage runtime of type 2")
    return content


def fill(app: Path, wheel: Path, interpreter: str) -> None:
    """Put all that the program needs, but what every desktop has, into the folder."""
    home = app / "usr"
    python = copy_interpreter(interpreter, home)
    packages = environment.install(python, wheel)
    add_window_libraries(home / "lib", packages / "PySide6" / "Qt")
    own = home / "lib" / "trunnion"
    environment.write_commands(own, "python3")
    values = {"BUILD": build_name(wheel)}
    files.write(own / "loops.sh", files.filled(files.HERE / "loops.sh.in", values))
    environment.compile_modules(python, packages, app)
    files.add_desktop_files(home / "share")
    files.write(app / "AppRun", (HERE / "AppRun").read_text(encoding="utf-8"), files.PROGRAM)
    shutil.copy(home / "share" / files.DESKTOP["trunnion.desktop"], app / "trunnion.desktop")
    shutil.copy(files.ICON, app / "trunnion.svg")
    (app / ".DirIcon").symlink_to("trunnion.svg")
    for name in ("LICENSE", "NOTICE"):
        shutil.copy(ROOT / name, home / "share" / name)


def add_window_libraries(folder: Path, qt: Path) -> None:
    """Add the libraries that Qt's plugin for X servers leaves to the system, and let Qt find them beside its own."""
    plugin = qt / "plugins" / "platforms" / "libqxcb.so"
    own = {path.name for path in (qt / "lib").iterdir()}
    wanted = [lib for lib in needed(plugin) if lib not in own and not FROM_HOST.fullmatch(lib)]
    found = [library_path(name) for name in wanted]
    copies = copy_libraries([*found, *(l for f in found for l in libraries(f))], folder)
    for copy in copies:
        link = qt / "lib" / copy.name
        link.symlink_to(os.path.relpath(copy, link.parent))


def needed(binary: Path) -> list[str]:
    """Return the names of the libraries that a binary itself asks for."""
    return environment.output(["patchelf", "--print-needed", binary]).split()


def archive(app: Path, target: Path, seconds: int) -> Path:
    """Pack the folder as an archive with one time and no person's name, and return it."""
    words = ["tar", "--sort=name", "--owner=0", "--group=0", "--numeric-owner"]
    dated = [f"--mtime=@{seconds}", "--use-compress-program=zstd -T0 -9 -q"]
    environment.output([*words, *dated, "-C", app.parent, "-cf", target, app.name])
    return target


def image(app: Path, runtime: bytes, target: Path, seconds: int) -> Path:
    """Write the runtime and behind it the folder as squashfs, and return the AppImage."""
    squashed = app.parent / "squashed"
    words = ["mksquashfs", str(app), str(squashed), "-root-owned", "-noappend", "-quiet"]
    dated = os.environ | {"SOURCE_DATE_EPOCH": str(seconds)}
    done = subprocess.run(
        [*words, "-no-progress", "-comp", "zstd", "-Xcompression-level", "6"],
        env=dated,
        capture_output=True,
        check=False,
    )
    if done.returncode:
        stop(f"mksquashfs could not pack {app}: {done.stderr.decode(errors='replace').strip()}")
    with target.open("wb") as made, squashed.open("rb") as packed:
        made.write(runtime)
        shutil.copyfileobj(packed, made)
    squashed.unlink()
    target.chmod(files.PROGRAM)
    return target


if __name__ == "__main__":
    raise SystemExit(main())
