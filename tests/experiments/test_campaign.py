"""The campaign engine: the same results whatever computes, and nothing lost or doubled by what goes wrong."""

import resource
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest
from tests.experiments.cases import Lost, Square

from carp_experiments.campaign import Workers, run_campaign
from carp_experiments.store import Store, open_store
from carp_spec import Refusal

CASES = [Square(number) for number in range(20)]
ROOT = Path(__file__).parent.parent.parent


def nothing() -> None:
    """Take no notice of progress."""


def digest_with(workers: Workers) -> str:
    with open_store(None, "squares") as store:
        run_campaign(CASES, store, workers, nothing)
        assert len(store.keys()) == len(CASES)
        return store.digest()


def test_the_digest_is_the_same_whoever_computes() -> None:
    from distributed import LocalCluster

    alone = digest_with(Workers(1))
    assert digest_with(Workers(2)) == alone
    with LocalCluster(  # type: ignore[no-untyped-call] # untyped there
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    ) as cluster:
        assert digest_with(Workers(backend="dask", scheduler=cluster.scheduler_address)) == alone


def test_a_run_goes_on_where_it_stopped(tmp_path: Path) -> None:
    advanced: list[None] = []
    with open_store(tmp_path / "store", "squares") as store:
        run_campaign(CASES[:7], store, Workers(), nothing)
    with open_store(tmp_path / "store", "squares") as store:
        run_campaign(CASES, store, Workers(), lambda: advanced.append(None))
        assert [key for key, _ in store.rows()] == [case.key for case in CASES]
    assert len(advanced) == len(CASES)


PROGRAM = """
import sys
from pathlib import Path
from carp_experiments.campaign import Workers, run_campaign
from carp_experiments.store import open_store
from carp_spec import Refusal
from tests.experiments.cases import Square
try:
    with open_store(Path(sys.argv[1]), "squares") as store:
        run_campaign([Square(n, 0.02) for n in range(120)], store, Workers(int(sys.argv[2])), lambda: None)
except Refusal as refusal:
    sys.exit(str(refusal))
"""


def assert_goes_on(path: Path) -> None:
    """The rest of the program's cases are added, and no case is lost or doubled."""
    with open_store(path, "squares") as store:
        run_campaign([Square(n) for n in range(120)], store, Workers(), nothing)
        assert [(key, row) for key, row in store.rows()] == [(f"{n:04}", {"square": n * n}) for n in range(120)]


def test_a_killed_run_loses_and_doubles_nothing(tmp_path: Path) -> None:
    path = tmp_path / "store"
    run = subprocess.Popen([sys.executable, "-c", PROGRAM, str(path), "1"], cwd=ROOT)
    while not path.exists() or _rows(path) < 5:
        time.sleep(0.02)
    run.send_signal(signal.SIGKILL)
    run.wait()
    written = _rows(path)
    assert 5 <= written < 120
    with open_store(path, "squares") as store:
        assert len(store.keys()) == written
    assert_goes_on(path)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_full_disk_is_told_and_the_run_goes_on_once_there_is_room(tmp_path: Path, workers: int) -> None:
    path, room = tmp_path / "store", 24 * 1024
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(path), str(workers)],
        cwd=ROOT,
        check=False,
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room)),
    )
    assert run.returncode == 1
    assert "cannot be written" in run.stderr
    assert "continues from there" in run.stderr
    told = [line for line in run.stderr.splitlines() if "resource_tracker" not in line]  # joblib's, now and then
    assert len(told) == 1
    assert 0 < _rows(path) < 120
    assert_goes_on(path)


def test_a_row_that_was_changed_is_noticed(tmp_path: Path) -> None:
    with open_store(tmp_path / "store", "squares") as store:
        store.add("0001", {"square": 1, "measured": {"seconds": 3}})
        before = store.digest()
    with closing(sqlite3.connect(tmp_path / "store")) as connection, connection:
        connection.execute("""UPDATE results SET row = '{"square":1,"measured":{"seconds":4}}'""")
    with open_store(tmp_path / "store", "squares") as store:
        assert store.digest() == before, "what was measured does not count"
    with closing(sqlite3.connect(tmp_path / "store")) as connection, connection:
        connection.execute("""UPDATE results SET row = '{"square":2}'""")
    with open_store(tmp_path / "store", "squares") as store, pytest.raises(Refusal, match="0001 is not the one"):
        store.digest()


def _rows(path: Path) -> int:
    try:
        with closing(sqlite3.connect(path, timeout=10)) as connection:
            return int(connection.execute("SELECT count(*) FROM results").fetchone()[0])
    except sqlite3.OperationalError:
        return 0


def test_a_lost_worker_is_told_and_the_run_can_go_on(tmp_path: Path) -> None:
    with open_store(tmp_path / "store", "squares") as store:
        with pytest.raises(Refusal, match=r"a worker was lost.*continues where it stopped"):
            run_campaign([*CASES, Lost()], store, Workers(2), nothing)
        run_campaign(CASES, store, Workers(), nothing)
        assert len(store.keys()) == len(CASES)


def test_a_file_that_is_no_store_is_refused_and_left_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("these are my notes, not a database\n" * 100)
    before = path.read_bytes()
    with pytest.raises(Refusal, match="cannot be used as a store"):
        Store(path, "squares")
    assert path.read_bytes() == before


def test_a_result_that_cannot_be_written_is_told_and_is_not_there(tmp_path: Path) -> None:
    with open_store(tmp_path / "store", "squares") as store:
        store.add("0001", {"square": 1})
        with pytest.raises(Refusal, match=r"the result of 0001 cannot be written"):
            store.add("0001", {"square": 2})
        assert dict(store.rows()) == {"0001": {"square": 1}}
