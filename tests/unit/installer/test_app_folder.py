"""The AppImage's folder starts what it is asked for, takes from the host what belongs to it, and is no AppImage without a runtime."""

from __future__ import annotations

import ast
import shutil
import subprocess

import pytest

from installer import environment, files
from installer.appimage import __main__ as appimage
from installer.appimage.interpreter import FILES_LEFT_OUT, FROM_HOST
from installer.project import (
    ROOT,
    build_name,
    commands,
    given_wheel,
    locked,
    project,
    source_date,
)
from installer.windows.start import module_words


@pytest.fixture
def app(tmp_path):
    """A folder of the AppImage whose interpreter prints what it was called with."""
    shutil.copy(appimage.HERE / "AppRun", tmp_path / "AppRun")
    own = tmp_path / "usr" / "lib" / "trunnion"
    own.mkdir(parents=True)
    (own / "loops.sh").write_text(files.filled(files.HERE / "loops.sh.in", {"BUILD": "0"}))
    python = tmp_path / "usr" / "bin" / "python3"
    files.write(python, '#!/bin/sh\necho "$@"\n', files.PROGRAM)
    (tmp_path / "part.step").write_text("")
    return tmp_path


@pytest.mark.parametrize(
    ("link", "words", "expected"),
    [
        ("", [], "-P LIB/trunnion-gui"),
        ("", ["part.step"], "-P LIB/trunnion-gui part.step"),
        ("", ["program", "part.step"], "-P LIB/trunnion program part.step"),
        ("", ["--version"], "-P LIB/trunnion --version"),
        ("", ["python", "-c", "1"], "-c 1"),
        ("/usr/local/bin/trunnion", ["part.step"], "-P LIB/trunnion part.step"),
        ("trunnion-python", ["session.py"], "session.py"),
        ("Trunnion.AppImage", ["info", "part.step"], "-P LIB/trunnion info part.step"),
    ],
)
def test_the_words_of_a_call_choose_window_command_or_interpreter(link, words, expected, app):
    called = subprocess.run(
        [str(app / "AppRun"), *words],
        cwd=app,
        env={"PATH": "/usr/bin:/bin", "HOME": str(app), "ARGV0": link},
        capture_output=True,
        text=True,
        check=True,
    )
    assert called.stdout.strip() == expected.replace("LIB", str(app / "usr" / "lib" / "trunnion"))


@pytest.mark.parametrize("name", ["libc.so.6", "libGL.so.1", "libX11-xcb.so.1", "libxcb.so.1"])
def test_the_hosts_libraries_are_left_to_it(name):
    assert FROM_HOST.fullmatch(name)


@pytest.mark.parametrize("name", ["libxcb-cursor.so.0", "libssl.so.3", "libcrypto.so.3"])
def test_libraries_that_a_desktop_may_lack_come_along(name):
    assert not FROM_HOST.fullmatch(name)


def test_parts_of_the_standard_library_that_are_left_out_are_named_whole():
    assert FILES_LEFT_OUT.fullmatch("_curses_panel.cpython-311-x86_64-linux-gnu.so")
    assert not FILES_LEFT_OUT.fullmatch("_ctypes.cpython-311-x86_64-linux-gnu.so")


@pytest.mark.parametrize("content", [b"", b"\x7fELF" + bytes(20), b"#!/bin/sh\n"])
def test_what_is_no_runtime_is_refused(content, tmp_path, capsys):
    path = tmp_path / "runtime"
    path.write_bytes(content)
    with pytest.raises(SystemExit) as ended:
        appimage.checked_runtime(str(path))
    assert ended.value.code == 2 and str(path) in capsys.readouterr().err


def test_an_image_is_the_runtime_and_the_folder_behind_it(app, tmp_path_factory):
    if not shutil.which("mksquashfs"):
        pytest.skip("mksquashfs is not here")
    runtime = b"\x7fELF\x02\x01\x01\x00" + appimage.MAGIC + bytes(1000)
    folder = tmp_path_factory.mktemp("image")
    shutil.copytree(app, folder / "app")
    images = [
        appimage.image(folder / "app", runtime, folder / name, 1000).read_bytes()
        for name in ("first", "second")
    ]
    assert images[0] == images[1], "two images of one folder differ"
    assert images[0].startswith(runtime)
    assert images[0][len(runtime) :].startswith(b"hsqs")  # the magic number of squashfs


def test_a_package_that_is_not_in_the_lock_ends_the_build(tmp_path, capsys):
    name, version = next(iter(locked().items()))
    add_package(tmp_path, name, version)
    environment._check(tmp_path)
    add_package(tmp_path, "stranger", "1.0")
    with pytest.raises(SystemExit):
        environment._check(tmp_path)
    assert "stranger 1.0" in capsys.readouterr().err


def test_a_version_that_is_not_the_locks_ends_the_build(tmp_path, capsys):
    add_package(tmp_path, "numpy", "0.1")
    with pytest.raises(SystemExit):
        environment._check(tmp_path)
    assert f"the lock has {locked()['numpy']}" in capsys.readouterr().err


def test_commands_and_paths_of_the_build_are_removed_with_their_records(tmp_path):
    packages = tmp_path / "lib" / "python3.11" / "site-packages"
    info = add_package(packages, "some", "1.0")
    command = tmp_path / "bin" / "some"
    files.write(command, "#!/build/python\n")
    files.write(info / "direct_url.json", "{}")
    files.write(packages / "some.py", "")
    rows = ["../../../bin/some,,", "some-1.0.dist-info/direct_url.json,,", "some.py,,"]
    files.write(info / "RECORD", "\n".join(rows))
    environment._remove_traces(packages)
    assert not command.exists() and not (info / "direct_url.json").exists()
    assert (info / "RECORD").read_text() == "some.py,,\n" and (packages / "some.py").exists()


def add_package(folder, name, version):
    """Lay out the metadata of a package as pip does, and return their folder."""
    info = folder / f"{name}-{version}.dist-info"
    files.write(info / "METADATA", f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    return info


def test_a_file_that_is_no_wheel_of_this_version_is_refused(tmp_path, capsys):
    other = tmp_path / "trunnion-0.0.1-py3-none-any.whl"
    for path in (tmp_path / "none.whl", other):
        with pytest.raises(SystemExit):
            given_wheel(str(path))
        assert "make wheel" in capsys.readouterr().err
        other.write_text("")


def test_loops_of_another_wheel_have_another_name(tmp_path):
    names = set()
    for content in (b"one", b"two"):
        (tmp_path / "wheel").write_bytes(content)
        names.add(build_name(tmp_path / "wheel"))
    assert len(names) == 2 and all(n.startswith(f"{project()['version']}-") for n in names)


def test_the_time_of_the_files_is_the_one_that_is_given(monkeypatch, capsys):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1000")
    assert source_date() == 1000
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(SystemExit):
        source_date()
    assert "'yesterday'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["-P", "-m", "trunnion.part.read.child", "x"], ["trunnion.part.read.child", "x"]),
        (["-m", "trunnion.batch.child"], ["trunnion.batch.child"]),
        (["-m", "http.server"], []),
        (["program", "-m"], []),
        ([], []),
    ],
)
def test_the_frozen_program_runs_its_own_modules_as_an_interpreter_would(words, expected):
    assert module_words(words) == expected


def test_the_windows_recipe_has_every_command_of_the_project():
    text = (ROOT / "installer" / "windows" / "trunnion.spec").read_text(encoding="utf-8")
    (named,) = (
        ast.literal_eval(line.value)
        for line in ast.parse(text).body
        if isinstance(line, ast.Assign) and ast.unparse(line.targets[0]) == "COMMANDS"
    )
    assert set(named) == set(commands())
    assert {name for name, console in named.items() if console} == set(project()["scripts"])
