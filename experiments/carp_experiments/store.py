"""A durable store of a campaign's results: one row a case, written as it comes, never twice."""

import hashlib
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing
from importlib.metadata import version
from pathlib import Path

import msgspec

from carp_spec import Refusal

Row = Mapping[str, object]
MEASURED = "measured"
TABLE = (
    "CREATE TABLE IF NOT EXISTS results (case_key TEXT PRIMARY KEY, version TEXT NOT NULL, digest TEXT NOT NULL, "
    "milliseconds INTEGER NOT NULL, row TEXT NOT NULL)"
)


class Store:
    """An SQLite file that holds the rows of one campaign, each under the key of its case.

    A row is in the file once `add` has returned, and stays there even if the process is killed. Each row has the
    version of carproof that computed it, its digest, and its processor time. The file has the name of its campaign;
    opening it for another campaign is refused.
    """

    def __init__(self, path: Path, campaign: str, *, of_any_version: bool = False) -> None:
        self._path = path
        self._version = version("carproof")
        identity = f"{campaign} by carproof {self._version}"
        try:
            self._connection = sqlite3.connect(path)
        except sqlite3.Error as error:
            raise self._unusable(error) from error
        try:
            known = self._identity(identity)
        except sqlite3.Error as error:
            self.close()
            raise self._unusable(error) from error
        if known != identity and not (of_any_version and known.startswith(f"{campaign} by carproof ")):
            self.close()
            raise self._refusal(f"it holds the results of another campaign, {known}, not of {identity}")

    def _identity(self, identity: str) -> str:
        """The campaign that the store holds the results of, this one if it is new."""
        with self._connection:
            self._connection.execute("CREATE TABLE IF NOT EXISTS campaign (identity TEXT NOT NULL)")
            self._connection.execute(TABLE)
            known = self._connection.execute("SELECT identity FROM campaign").fetchone()
            if known is None:
                self._connection.execute("INSERT INTO campaign VALUES (?)", (identity,))
        return identity if known is None else str(known[0])

    def keys(self) -> set[str]:
        """The keys of the cases that are done."""
        return {key for (key,) in self._connection.execute("SELECT case_key FROM results")}

    def add(self, key: str, row: Row, milliseconds: int = 0) -> None:
        """Write the row of a case; raises `Refusal` if it cannot be written, and then it is not there at all."""
        record = (key, self._version, digest_of(row), milliseconds, _encode(row).decode())
        try:
            with self._connection:
                self._connection.execute("INSERT INTO results VALUES (?, ?, ?, ?, ?)", record)
        except sqlite3.Error as error:
            message = f"the result of {key} cannot be written: {error}; what is there is whole, and the same command "
            raise self._refusal(message + "continues from there once that is put right") from error

    def rows(self, keys: Iterable[str] | None = None) -> Iterator[tuple[str, Row]]:
        """The rows of these cases, or all, in the order of their keys; raises `Refusal` if one is not as written."""
        wanted = None if keys is None else set(keys)
        for key, digest, text in self._connection.execute(
            "SELECT case_key, digest, row FROM results ORDER BY case_key"
        ):
            if wanted is None or key in wanted:
                row: Row = msgspec.json.decode(text)
                if digest_of(row) != digest:
                    raise self._refusal(f"the result of {key} is not the one that was written")
                yield key, row

    def digest(self, keys: Iterable[str] | None = None) -> str:
        """A digest of these rows, or all, whatever their order; measured times do not count."""
        digest = hashlib.sha256()
        for key, row in self.rows(keys):
            digest.update(_encode({"case": key, "row": digest_of(row)}))
        return digest.hexdigest()

    def seconds(self, keys: Iterable[str]) -> float:
        """The processor time of these cases."""
        wanted = set(keys)
        spent = self._connection.execute("SELECT case_key, milliseconds FROM results")
        return float(sum(milliseconds for key, milliseconds in spent if key in wanted)) / 1000

    def close(self) -> None:
        """Close the file."""
        self._connection.close()

    def _unusable(self, error: sqlite3.Error) -> Refusal:
        return self._refusal(f"it cannot be used as a store of results: {error}")

    def _refusal(self, message: str) -> Refusal:
        return Refusal("request", str(self._path), "campaign/store", message)


def stored_rows(path: Path, campaign: str) -> Mapping[str, Row]:
    """The rows of a campaign by the keys of their cases, whichever version of carproof has computed them."""
    with closing(Store(path, campaign, of_any_version=True)) as store:
        return dict(store.rows())


def open_store(path: Path | None, campaign: str) -> closing[Store]:
    """Open the store of a campaign, or one in memory if there is no path; it belongs to this version of carproof."""
    return closing(Store(path or Path(":memory:"), campaign))


def digest_of(row: Row) -> str:
    """The digest of a row, but for its field `measured`, which holds times and the like."""
    return hashlib.sha256(_encode({name: value for name, value in row.items() if name != MEASURED})).hexdigest()


def _encode(row: Row) -> bytes:
    return msgspec.json.encode(row, order="sorted")
