"""The commands of the menu *Shop*."""

from __future__ import annotations

from trunnion_gui.actions import Command
from trunnion_gui.menus.window_access import WindowAccess


def add_shop_commands(window: WindowAccess) -> None:
    """Add them to a window's registry."""

    def command(id: str, text: str, page: str, keys: str, icon: str, help: str) -> None:
        window.registry.add(
            Command(
                id=f"shop.{id}",
                text=text,
                run=lambda: window.show_shop(page),
                icon=icon,
                keys=keys,
                help=help,
                menu="Shop",
            )
        )

    command(
        "tools",
        "Tools…",
        "tools",
        "Ctrl+T",
        "tool",
        "The catalogue of tools and what is in the machines",
    )
    command("machines", "Machines…", "machines", "", "setup", "The machines of the catalogue")
    command(
        "materials", "Materials…", "materials", "", "kind", "The materials with their cutting data"
    )
