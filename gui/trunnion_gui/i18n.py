"""Words in the person's language: English in the code, other languages as data in resources."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files

_chosen = "en"


def languages() -> tuple[str, ...]:
    """Return the languages the window speaks."""
    folder = files("trunnion_resources") / "translations"
    return (
        "en",
        *sorted(f.name.removesuffix(".json") for f in folder.iterdir() if f.name.endswith(".json")),
    )


def use(language: str) -> None:
    """Speak a language from now on (widgets made earlier keep their words); an unknown one means English."""
    global _chosen
    _chosen = language if language in languages() else "en"


def tr(text: str) -> str:
    """Return a text in the chosen language, the English one when nobody translated it."""
    return _words(_chosen).get(text, text)


@cache
def _words(language: str) -> dict[str, str]:
    if language == "en":
        return {}
    return json.loads(
        (files("trunnion_resources") / "translations" / f"{language}.json").read_text("utf-8")
    )
