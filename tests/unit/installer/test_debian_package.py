"""The Debian package says of itself what the project says: commands, packages that it needs, file type, manual page."""

from __future__ import annotations

import configparser
import os
import re
import shutil
import subprocess
from email.parser import Parser

import pytest
from lxml import etree

from installer import files
from installer.deb import control
from installer.project import GROUPS, ROOT, commands, debian_packages, project
from trunnion.store.project_file import PROJECT_SUFFIX
from trunnion_gui.display import DRAWING, XCB

DESKTOP = ROOT / "installer" / "desktop"
MIME = "{http://www.freedesktop.org/standards/shared-mime-info}"


def fields() -> dict[str, str]:
    """Return the fields of the control file by name."""
    text = control.control("3.11", "amd64", "Some Body <some@body>", 2048)
    return dict(Parser().parsestr(text))


def desktop_entry() -> configparser.SectionProxy:
    """Return the menu entry."""
    parser = configparser.ConfigParser(interpolation=None)
    parser.optionxform = str
    parser.read_string((DESKTOP / "trunnion.desktop").read_text(encoding="utf-8"))
    return parser["Desktop Entry"]


def test_the_control_file_has_the_fields_that_debian_demands():
    demanded = {"Package", "Version", "Architecture", "Maintainer", "Description"}  # policy 5.3
    found = fields()
    assert demanded <= set(found) and all(found.values())
    assert found["Version"] == f"{project()['version']}-1"
    summary, *rest = found["Description"].splitlines()
    assert len(summary) < 80 and not summary.endswith(".")
    assert rest and all(line.startswith(" ") for line in rest)


def test_the_package_needs_what_the_window_looks_for_at_its_start():
    needed = set(fields()["Depends"].split(", "))
    assert {*DRAWING.values(), *XCB.values()} <= needed
    assert "python3.11" in needed and "python3-venv" not in needed


def test_every_group_of_debian_packages_has_names():
    assert all(debian_packages(group) for group in GROUPS)
    asked = subprocess.run(
        ["sh", str(ROOT / "installer" / "debian.sh"), "--names", "sound"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert asked.returncode == 2 and len(asked.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("version", "expected"),
    [
        ("0.1.0", "0.1.0-1"),
        ("1.0rc2", "1.0~rc2-1"),
        ("1.0a1", "1.0~a1-1"),
        ("1.0.dev3", "1.0~dev3-1"),
    ],
)
def test_a_version_before_a_release_is_older_than_it(version, expected):
    assert control.debian_version(version) == expected


def test_the_package_has_every_command_of_the_project_and_its_interpreter():
    scripts = control.command_scripts()
    assert set(scripts) == {*commands(), control.INTERPRETER}
    for name, text in scripts.items():
        subprocess.run(["sh", "-n"], input=text, text=True, check=True)
        run = f"{control.HOME}/bin/python" + (
            f" -P {control.HOME}/bin/{name}" * (name in commands())
        )
        assert text.endswith(f'exec {run} "$@"\n'), name


@pytest.mark.parametrize("name", control.SCRIPTS)
def test_the_scripts_of_the_package_are_shell(name):
    subprocess.run(["sh", "-n", str(control.HERE / name)], check=True)


def test_the_menu_entry_starts_a_command_of_the_package_with_its_icon():
    entry = desktop_entry()
    assert entry["Exec"].split() == ["trunnion-gui", "%f"]
    assert "trunnion-gui" in commands()
    assert files.ICON_PLACE.endswith(f"/{entry['Icon']}.svg") and files.ICON.is_file()
    if shutil.which("desktop-file-validate"):
        subprocess.run(["desktop-file-validate", str(DESKTOP / "trunnion.desktop")], check=True)


def test_the_menu_entry_opens_the_type_that_project_files_get():
    (kind,) = etree.parse(DESKTOP / "trunnion.xml").getroot()
    assert kind.get("type") in desktop_entry()["MimeType"].split(";")
    assert [glob.get("pattern") for glob in kind.iter(f"{MIME}glob")] == [f"*{PROJECT_SUFFIX}"]


def test_the_manual_page_has_every_command_and_no_hyphen_that_would_break_a_line():
    page = control.manual_page([("recognize", "find features -- all"), ("odd", ".dot")], 0)
    assert ".TP\n.B recognize\nfind features \\-\\- all\n.TP\n.B odd\n\\&.dot\n" in page
    assert '"1970-01-01"' in page and "@" not in page


def test_a_template_with_a_word_that_nobody_fills_ends_the_build(tmp_path, capsys):
    template = tmp_path / "template"
    template.write_text("a @WORD@ here")
    assert files.filled(template, {"WORD": "b"}) == "a b here"
    with pytest.raises(SystemExit) as ended:
        files.filled(template, {})
    assert ended.value.code == 2 and "@WORD@" in capsys.readouterr().err


def test_files_get_one_time_and_the_modes_of_a_package(tmp_path):
    program, data = tmp_path / "program", tmp_path / "folder" / "data"
    data.parent.mkdir()
    for path, mode in ((program, 0o700), (data, 0o600)):
        path.write_text("x" * 1025)
        path.chmod(mode)
    files.with_one_time(tmp_path, 1000)
    assert {p.stat().st_mtime for p in (program, data, data.parent)} == {1000}
    assert program.stat().st_mode & 0o777 == 0o755 and data.stat().st_mode & 0o777 == 0o644
    assert files.size_kib(tmp_path) == 4
    assert os.stat(data.parent).st_mode & 0o777 == 0o755


def test_the_installed_size_is_a_number_and_every_word_of_the_texts_is_filled():
    assert fields()["Installed-Size"] == "2048"
    everything = "\n".join([*fields().values(), *control.command_scripts().values()])
    assert not re.search(r"@[A-Z]+@", everything)
