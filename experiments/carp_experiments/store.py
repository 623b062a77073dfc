"""A durable store of a campaign's results: one row a case, written as it comes, never twice."""

import hashlib
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

import msgspec

from carp_spec import Refusal

Row = Mapping[str, object]


class Store:
    """An SQLite file that holds the rows of one campaign, each under the key of its case.

    A row is in the file once `add` has returned, and stays there whatever becomes of the process. The file
    remembers which campaign it belongs to; opening it for another one is refused.
    """

    def __init__(self, path: Path, campaign: str) -> None:
        self._path = path
        try:
            self._connection = sqlite3.connect(path)
            with self._connection:
                self._connection.execute("CREATE TABLE IF NOT EXISTS campaign (identity TEXT NOT NULL)")
                self._connection.execute(
                    "CREATE TABLE IF NOT EXISTS results (case_key TEXT PRIMARY KEY, row TEXT NOT NULL)"
                )
                known = self._connection.execute("SELECT identity FROM campaign").fetchone()
                if known is None:
                    self._connection.execute("INSERT INTO campaign VALUES (?)", (campaign,))
        except sqlite3.Error as error:
            raise self._refusal(f"it cannot be used as a store of results: {error}") from error
        if known is not None and known[0] != campaign:
            raise self._refusal(f"it holds the results of another campaign, {known[0]}, not of {campaign}")

    def keys(self) -> set[str]:
        """The keys of the cases that are done."""
        return {key for (key,) in self._connection.execute("SELECT case_key FROM results")}

    def add(self, key: str, row: Row) -> None:
        """Write the row of a case; raises `Refusal` if it cannot be written, and then it is not there at all."""
        try:
            with self._connection:
                self._connection.execute("INSERT INTO results VALUES (?, ?)", (key, _encode(row).decode()))
        except sqlite3.Error as error:
            raise self._refusal(f"the result of {key} cannot be written: {error}; what is there is whole") from error

    def rows(self) -> Iterator[tuple[str, Row]]:
        """The rows by key, in the order of the keys."""
        for key, row in self._connection.execute("SELECT case_key, row FROM results ORDER BY case_key"):
            yield key, msgspec.json.decode(row)

    def digest(self) -> str:
        """A digest of all rows, the same in whatever order they came."""
        digest = hashlib.sha256()
        for key, row in self.rows():
            digest.update(_encode({"case": key, "row": row}))
        return digest.hexdigest()

    def close(self) -> None:
        """Close the file."""
        self._connection.close()

    def _refusal(self, message: str) -> Refusal:
        return Refusal("request", str(self._path), "campaign/store", message)


@contextmanager
def open_store(path: Path | None, campaign: str) -> Iterator[Store]:
    """Open the store of a campaign, or one in memory if there is no path; it belongs to this version of carproof."""
    store = Store(path or Path(":memory:"), f"{campaign} by carproof {version('carproof')}")
    try:
        yield store
    finally:
        store.close()


def _encode(row: Row) -> bytes:
    return msgspec.json.encode(row, order="sorted")
