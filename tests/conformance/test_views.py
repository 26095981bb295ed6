"""What every view of a family must bring to the window, whoever wrote it: ours, and those of packages in `tests/families`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from PySide6.QtGui import QColor

from own_packages import names
from trunnion import registry
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.recognize.contract import feature_kinds
from trunnion_gui import i18n
from trunnion_gui.families.contract import FamilyView
from trunnion_gui.look.colours import kind_label
from trunnion_gui.look.words import sentence

sys.path.append(str(Path(__file__).resolve().parent.parent / "gui"))  # the fake engine's home
VIEWS = names("views")
by_name = pytest.mark.parametrize("name", VIEWS)


@pytest.fixture(scope="module")
def shown(packages, qapp, tmp_path_factory):
    """One window for all views, over the fake engine, without a part."""
    from trunnion_gui.window import Window

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRUNNION_SETTINGS", str(tmp_path_factory.mktemp("settings")))
        window = Window("fake_engine:FakeEngine")
        window.unsaved.confirms = False
        window.show()
        yield window
        window.close()


def kinds_of(name) -> tuple[str, ...]:
    """Return the kinds that the view presents, else those of its family that it leaves to the plain view."""
    return tuple(k.name for k in registry.get("families", name).kinds)


def made_up(name) -> Recognition:
    """Return two features of each kind of a family."""
    features = tuple(
        Feature(
            id=f"{kind}-{n:02}",
            kind=kind,
            faces=(FaceRole(role="face", face=2 * k + n),),
            sizes={"depth": 5.0, "diameter": 8.0},
        )
        for k, kind in enumerate(kinds_of(name))
        for n in (1, 2)
    )
    return Recognition(family=name, features=features)


def test_a_view_of_a_package_is_among_them():
    assert set(VIEWS) > {"panel", "surface"}


@by_name
def test_it_is_of_a_family_and_has_its_name(name, shown):
    assert name in registry.names("families")
    assert isinstance(shown.views[name], FamilyView) and shown.views[name].name == name


@by_name
def test_it_presents_kinds_that_its_family_declares(name, shown):
    assert set(shown.views[name].kinds) <= set(kinds_of(name))


@by_name
def test_every_feature_stands_in_one_class_with_words_and_a_colour(name, shown):
    found = made_up(name)
    classes = list(shown.views.classes(found))
    listed = [f.id for c in classes for f in c.features]
    assert sorted(listed) == sorted(f.id for f in found)
    assert all(c.words and "_" not in c.words and QColor(c.colour).isValid() for c in classes)
    assert len({c.name for c in classes}) == len(classes)


@by_name
def test_the_legend_has_a_row_for_each_class(name, shown):
    from trunnion_gui.look import legend

    rows = legend.features(made_up(name), shown.views)
    assert len(rows) == len(list(shown.views.classes(made_up(name))))
    assert sum(int(count) for _, _, count in rows) == len(made_up(name).features)


@by_name
def test_its_columns_answer_for_each_of_its_features(name, shown):
    view, found = shown.views[name], made_up(name)
    for column in view.columns():
        assert column.title
        for f in found.of_kind(*view.kinds):
            assert isinstance(column.words(f), str) and isinstance(column.cell_tip(f), str)
            assert column.is_ticked is None or column.is_ticked(f) in (True, False)
    assert all(isinstance(view.size(f), str) for f in found)
    assert isinstance(view.remark(found), str)


@by_name
def test_menus_of_its_features_have_words_and_no_entry_twice(name, shown):
    for f in made_up(name):
        entries = [a.text() for a in shown.docks.features.menu(f).actions() if not a.isSeparator()]
        assert all(entries) and len(set(entries)) == len(entries)
    faces = [
        a.text() for a in shown.views.face_menu(shown, (1, 2)).actions() if not a.isSeparator()
    ]
    assert all(faces) and len(set(faces)) == len(faces)


@by_name
def test_its_panels_offer_its_own_settings_and_no_other_familys(name, shown):
    found, views = made_up(name), shown.views
    for family in registry.names("families"):
        recogniser = registry.get("families", family).settings.GROUP
        assert views.offers(recogniser, found) == (family == name), recogniser
    groups = {
        s.GROUP for p in registry.names("planners") for s in registry.get("planners", p).settings
    }
    planned = name in registry.names("planners")
    own = {s.GROUP for s in registry.get("planners", name).settings} if planned else set()
    assert all(views.offers(group, found) for group in own)
    assert all(
        views.offers(group, found) == (group in own)
        for group in groups
        if any(view.owns(group) for view in views)
    )


@by_name
def test_its_docks_and_blocks_have_places(name, shown):
    docks, panels = shown.views[name].docks(), shown.views[name].blocks()
    assert len({d.name for d in docks}) == len(docks) and all(d.title for d in docks)
    assert all(shown.arrangement.dock(d.name).windowTitle() for d in docks)
    assert set(panels) <= set(shown.panels)


def commands_of(view, window):
    """Return the commands that a view adds to a window."""
    found = []
    registry_of_view = SimpleNamespace(add=found.append, action=window.registry.action)
    view.add_commands(SimpleNamespace(registry=registry_of_view, viewport=window.viewport))
    return found


def test_every_command_has_one_name_words_and_a_place(shown):
    commands = shown.registry.commands()
    assert len({c.id for c in commands}) == len(commands)
    assert all(c.text and "." in c.id for c in commands)
    keys = [c.keys for c in commands if c.keys]
    assert len(set(keys)) == len(keys)


@pytest.mark.parametrize("language", [name for name in i18n.languages() if name != "en"])
def test_what_views_show_is_translated(language, shown):
    known: set[str] = set()
    for folder in registry.resource_folders("translations"):
        file = folder / f"{language}.json"
        known |= set(json.loads(file.read_text("utf-8"))) if file.is_file() else set()
    commands = [c for name in VIEWS for c in commands_of(shown.views[name], shown)]
    words = {word for c in commands for word in (c.text, c.help, c.menu) if word}
    words |= {kind_label(kind) for kind in feature_kinds()}
    assert words - known == set()


def test_a_kind_reads_with_a_capital_first_letter_in_table_and_legend(shown):
    (plain,) = FamilyView(shown.document).classes("open_pocket", ())
    assert plain.words == sentence(kind_label("open_pocket")) == "Open pocket"
