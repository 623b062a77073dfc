"""Makes the package's long description of the README: a package index shows no file of the repository.

Links and pictures lead to the URL `Source` of pyproject.toml; while it has none, a link is its text alone, and a
picture is left out.
"""

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

LINK = re.compile(r"(!?)\[([^\[\]\n]*)\]\((?![a-z]+:)([^()\n]*)\)")


class DescriptionHook(MetadataHookInterface):
    """Adds the field `readme`."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Add it to the fields of `[project]`."""
        text = Path(self.root, "README.md").read_text(encoding="utf-8")
        described = description(text, metadata.get("urls", {}).get("Source"))
        metadata["readme"] = {"content-type": "text/markdown", "text": described}


def description(readme: str, source: str | None) -> str:
    """The README with absolute links."""

    def absolute(link: re.Match[str]) -> str:
        picture, text, path = link.groups()
        if source is None:
            return "" if picture else text
        return f"{picture}[{text}]({source}/{'raw' if picture else 'blob'}/main/{path})"

    return re.sub(r"\n{3,}", "\n\n", LINK.sub(absolute, readme))
