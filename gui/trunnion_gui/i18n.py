"""Words in the person's language: English in the code, other languages as data in the resources of the program and of packages."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files

from trunnion.registry import OWN_RESOURCES, resource_folders

_language = "en"


def languages() -> tuple[str, ...]:
    """Return the languages the window speaks."""
    folder = files(OWN_RESOURCES) / "translations"
    return (
        "en",
        *sorted(f.name.removesuffix(".json") for f in folder.iterdir() if f.name.endswith(".json")),
    )


def use(language: str) -> None:
    """Speak a language from now on (widgets made earlier keep their words); an unknown one means English."""
    global _language
    _language = language if language in languages() else "en"


def tr(text: str) -> str:
    """Return a text in the chosen language, the English one when nobody translated it."""
    return _words(_language).get(text, text)


@cache
def _words(language: str) -> dict[str, str]:
    if language == "en":
        return {}
    found: dict[str, str] = {}
    # The program's own words come last: a package adds words, it changes none.
    for folder in reversed(resource_folders("translations")):
        file = folder / f"{language}.json"
        found |= json.loads(file.read_text("utf-8")) if file.is_file() else {}
    return found
