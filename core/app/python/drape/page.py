"""HTML pages, in a notebook or in a browser."""

from __future__ import annotations

import html
import pathlib
import tempfile
import webbrowser


class Page:
    """An HTML page that needs no other file and no network."""

    def __init__(self, text: str):
        self.text = text

    def open(self) -> pathlib.Path:
        """Open the page in a browser; returns the file, which stays."""
        with tempfile.NamedTemporaryFile("w", suffix=".html", prefix="drape_", delete=False,
                                         encoding="utf-8") as file:
            file.write(self.text)
        webbrowser.open(pathlib.Path(file.name).as_uri())
        return pathlib.Path(file.name)

    def _repr_html_(self) -> str:
        # A frame keeps the page's scripts and styles apart from the notebook's.
        return (f'<iframe srcdoc="{html.escape(self.text)}" width="100%" height="620" '
                'style="border: 0" sandbox="allow-scripts"></iframe>')
