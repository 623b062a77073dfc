"""Groups of commands, each command a module that is loaded when it is asked for."""

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from importlib import import_module
from typing import TYPE_CHECKING, Any

import click

from carproof.command_line.tables import remark

if TYPE_CHECKING:
    from importlib.metadata import EntryPoints

WIDEST_SUMMARY = 200


class LazyGroup(click.Group):
    """A group of commands by heading: `sections` has each command's module, which defines `command`.

    Other packages add commands to the last heading by entry points of the group `added`. `renamed` has the old names of
    commands with the words that stand for them now.
    """

    def __init__(
        self,
        *arguments: Any,  # noqa: ANN401 - those of click
        sections: Mapping[str, Mapping[str, str]],
        added: str = "",
        renamed: Mapping[str, Sequence[str]] = {},
        **options: Any,  # noqa: ANN401 - those of click
    ) -> None:
        super().__init__(*arguments, **options)
        self.sections = sections
        self.added = added
        self.renamed = renamed
        self.modules = {name: module for section in sections.values() for name, module in section.items()}

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The commands in the order in which they are listed."""
        del ctx
        return [*self.modules, *sorted(self._entry_points().names)]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load a command."""
        del ctx
        if cmd_name in self.modules:
            command = import_module(self.modules[cmd_name]).command
        elif cmd_name in (points := self._entry_points()).names:
            command = points[cmd_name].load()
        else:
            return None
        assert isinstance(command, click.Command)  # noqa: S101 - a promise of ours, not of the user's
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command; an old name stands for the new one, and the nearest is suggested for an unknown one."""
        name = args[0]
        if name in self.renamed:
            now = self.renamed[name]
            remark(f"{ctx.command_path} {name} is called {ctx.command_path} {' '.join(now)} now.")
            return super().resolve_command(ctx, [*now, *args[1:]])
        if name[:1] != "-" and self.get_command(ctx, name) is None and not ctx.resilient_parsing:
            near = get_close_matches(name, self.list_commands(ctx), 1)
            hint = f"Did you mean {near[0]}?" if near else f"{ctx.command_path} --help lists them."
            raise click.UsageError(f"No such command {name!r}. {hint}", ctx)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands heading by heading, each with its whole summary."""
        sections = {heading: [*names] for heading, names in self.sections.items()}
        *_, last = sections.values()
        last += sorted(self._entry_points().names)
        for heading, names in sections.items():
            commands = {name: self.get_command(ctx, name) for name in names}
            with formatter.section(heading):
                formatter.write_dl(
                    [(name, each.get_short_help_str(limit=WIDEST_SUMMARY)) for name, each in commands.items() if each]
                )

    def _entry_points(self) -> "EntryPoints":
        from importlib.metadata import entry_points  # noqa: PLC0415 - slow to load, and most commands are ours

        return entry_points(group=self.added)
