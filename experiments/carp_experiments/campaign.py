"""The campaign engine: independent cases, each a pure function of its data, mapped over workers."""

import warnings
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from time import process_time_ns
from typing import Literal, Protocol, TypeAlias

from carp_experiments.store import Row, Store
from carp_spec import Refusal

Result: TypeAlias = tuple[str, Row, int]
Backend: TypeAlias = Literal["loky", "dask"]
UNUSED = ".*You could benefit from adjusting the input task"


class Case(Protocol):
    """One case: its name in the store, and its computation. It must be the same in every process."""

    @property
    def key(self) -> str:
        """The name of the case, unique in its campaign."""

    def run(self) -> Row:
        """Compute the row of the case from the case alone."""


@dataclass(frozen=True, slots=True)
class Workers:
    """The workers: `count` processes on this machine (`loky`), or the cluster of a dask scheduler."""

    count: int = 1
    backend: Backend = "loky"
    scheduler: str | None = None


def run_campaign(cases: Sequence[Case], store: Store, workers: Workers, advance: Callable[[], None]) -> None:
    """Run the cases that the store does not have yet; `advance` is called for each case, stored ones included.

    Raises `Refusal` if a result cannot be written or a worker is lost; the results until then are in the store,
    and the same call continues where it stopped.
    """
    done = store.keys()
    for case in cases:
        if case.key in done:
            advance()
    missing = [case for case in cases if case.key not in done]
    try:
        with warnings.catch_warnings(), closing(_results(missing, workers)) as results:
            warnings.filterwarnings("ignore", UNUSED, UserWarning)  # joblib's, beside the refusal that says why
            for key, row, milliseconds in results:
                store.add(key, row, milliseconds)
                advance()
    except (OSError, RuntimeError) as error:
        why = str(error).partition(". ")[0].rstrip(".")
        message = f"a worker was lost ({why}); run the same command again, and it continues where it stopped"
        raise Refusal("request", "$", "campaign/workers", message) from error


def _results(cases: Sequence[Case], workers: Workers) -> Generator[Result, None, None]:
    import joblib  # noqa: PLC0415 - loads numpy

    if workers.backend == "dask":
        from distributed import Client  # noqa: PLC0415 - only a campaign on a cluster needs it

        with Client(workers.scheduler), joblib.parallel_config("dask"):  # type: ignore[no-untyped-call] # untyped there
            yield from joblib.Parallel(return_as="generator_unordered")(map(joblib.delayed(_run), cases))
    elif workers.count == 1:
        yield from map(_run, cases)
    else:
        with joblib.parallel_config("loky", n_jobs=workers.count):
            yield from joblib.Parallel(return_as="generator_unordered")(map(joblib.delayed(_run), cases))


def _run(case: Case) -> Result:
    started = process_time_ns()
    row = case.run()
    return case.key, row, (process_time_ns() - started) // 1_000_000
