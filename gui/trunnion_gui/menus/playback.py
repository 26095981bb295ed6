"""The commands of the menu *Playback*."""

from __future__ import annotations

from collections.abc import Callable

from trunnion_gui.actions import Command
from trunnion_gui.menus.window_access import WindowAccess


def add_playback_commands(window: WindowAccess) -> None:
    """Add them to a window's registry."""
    player = window.player

    def command(
        id: str, text: str, run: Callable[[], object], icon: str, keys: str, help: str = ""
    ) -> None:
        window.registry.add(
            Command(
                id=f"play.{id}",
                text=text,
                run=run,
                icon=icon,
                keys=keys,
                help=help,
                menu="Playback",
                enabled=lambda: player.is_ready,
            )
        )

    window.registry.add(
        Command(
            id="play.show",
            text="Playback",
            run=window.show_playback,
            icon="playback",
            keys="P",
            checkable=True,
            menu="Playback",
            help="See the stock being cut, block by block",
            enabled=lambda: player.can_play or player.is_on,
        )
    )
    command("run", "Play", player.toggle, "play", "K", "Play or pause")
    command("back", "One block back", lambda: player.step(-1), "step_back", ",")
    command("forward", "One block on", lambda: player.step(1), "step_forward", ".")
    command("previous", "Previous operation", lambda: player.skip(-1), "previous", "J")
    command("next", "Next operation", lambda: player.skip(1), "next", "L")
    command("begin", "To the beginning", lambda: player.go(0.0), "first", "Home")
    command("end", "To the end", lambda: player.go(player.end), "last", "End")
    command("slower", "Slower", lambda: player.faster(-1), "slower", "-")
    command("faster", "Faster", player.faster, "faster", "+")
