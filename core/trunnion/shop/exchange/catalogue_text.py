"""Tools and holders as catalogue files: the same tables that a shop writes into its own folder."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from trunnion.model.tool import Holder
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.contract import Loss, LossKind
from trunnion.shop.exchange.fields import entry_of


def tools_text(cutters: Iterable[Cutter], losses: Iterable[Loss] = (), source: str = "") -> str:
    """Return a file with a table [tool.NAME] for each cutter, over each what was assumed of it."""
    assumed: dict[str, list[str]] = {}
    for loss in losses:
        if loss.kind is LossKind.ASSUMED and loss.field not in ("name", "holder_rows"):
            assumed.setdefault(loss.tool, []).append(loss.field)
    blocks = [f"# Tools of {_comment(source)}.\n"] if source else []
    for cutter in cutters:
        fields = dict.fromkeys(assumed.get(cutter.tool.name, []))
        note = f"# Assumed, to be checked: {', '.join(fields)}.\n" if fields else ""
        blocks.append(f"{note}[tool.{quoted(cutter.tool.name)}]\n{_fields(entry_of(cutter))}")
    return "\n".join(blocks)


def holders_text(holders: Iterable[Holder], source: str = "") -> str:
    """Return a file with a table for each holder."""
    blocks = [f"# Holders of {_comment(source)}.\n"] if source else []
    for holder in holders:
        fields = {"title": holder.name, "rows": holder.rows}
        blocks.append(f"[{quoted(holder.name)}]\n{_fields(fields)}")
    return "\n".join(blocks)


def foreign_holders(cutters: Sequence[Cutter], known: Mapping[str, Holder]) -> tuple[Holder, ...]:
    """Return the holders of cutters that the catalogue doesn't have, each once, by name."""
    own = {c.tool.holder.name: c.tool.holder for c in cutters}
    return tuple(own[name] for name in sorted(own) if name not in known)


def _fields(fields: Mapping[str, Any]) -> str:
    return "".join(f"{name} = {_value(value)}\n" for name, value in fields.items())


def _value(value: Any) -> str:
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (tuple, list)):
        return f"[{', '.join(map(_value, value))}]"
    return repr(value)


def quoted(words: str) -> str:
    """Return a text as a basic string of TOML: JSON's escapes are among those of TOML, which escapes the delete character too."""
    return json.dumps(words.encode("utf-8", "replace").decode(), ensure_ascii=False).replace(
        "\x7f", "\\u007f"
    )


def _comment(words: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in words.encode("utf-8", "replace").decode())
