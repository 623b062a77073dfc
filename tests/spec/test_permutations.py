"""Chance that every program can repeat: SplitMix64, shuffles and sampled orders."""

from collections.abc import Iterator
from itertools import islice, permutations
from math import factorial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carp_spec.permutations import orders, shuffle, splitmix64

SEEDS = st.integers(0, 2**64 - 1)


def never() -> Iterator[int]:
    """A stream from which nothing may be drawn."""
    raise AssertionError("a number was drawn")
    yield 0  # type: ignore[unreachable] # makes this a generator


def test_splitmix64_gives_the_published_numbers() -> None:
    assert list(islice(splitmix64(1234567), 5)) == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]


@given(seed=SEEDS)
def test_splitmix64_takes_its_seed_modulo_a_word_and_yields_words(seed: int) -> None:
    numbers = list(islice(splitmix64(seed), 4))
    assert numbers == list(islice(splitmix64(seed + 2**64), 4))
    assert all(0 <= number < 2**64 for number in numbers)


def test_a_shuffle_swaps_from_the_last_position_down() -> None:
    assert shuffle("abcd", iter([5, 3, 0])) == ("d", "c", "a", "b")


@given(seed=SEEDS, size=st.integers(0, 8))
def test_a_shuffle_is_a_permutation_and_draws_one_number_fewer_than_items(seed: int, size: int) -> None:
    stream, twin = splitmix64(seed), splitmix64(seed)
    assert sorted(shuffle(range(size), stream)) == list(range(size))
    list(islice(twin, max(size - 1, 0)))
    assert next(stream) == next(twin)


@pytest.mark.parametrize("size", range(6))
def test_all_orders_come_once_and_in_lexicographic_order(size: int) -> None:
    every = list(orders(size, None, never()))
    assert every == sorted(set(every))
    assert len(every) == factorial(size)


@given(seed=SEEDS, sample=st.integers(1, 23))
def test_sampled_orders_are_the_first_distinct_shuffles_of_the_stream(seed: int, sample: int) -> None:
    stream = splitmix64(seed)
    first: list[tuple[int, ...]] = []
    while len(first) < sample:
        order = shuffle(range(4), stream)
        first = first if order in first else [*first, order]
    stream_after = next(stream)
    again = splitmix64(seed)
    assert list(orders(4, sample, again)) == sorted(first)
    assert next(again) == stream_after


@pytest.mark.parametrize(("size", "sample"), [(0, None), (3, None), (3, 6), (3, 7), (1, 1), (4, 24)])
def test_where_all_orders_are_wanted_or_fit_the_sample_none_is_drawn(size: int, sample: int | None) -> None:
    assert list(orders(size, sample, never())) == list(permutations(range(size)))
