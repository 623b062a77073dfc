# `make demo`, `make quick` and `make test` each set everything up on a machine with Python and make; the demo needs less.
PYTHON ?= python3
BIN := .venv/bin

export PIP_CONSTRAINT := $(CURDIR)/constraints.txt
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.DELETE_ON_ERROR:
.PHONY: bench install compiled demo quick quick-tests test checked ci thorough paper-sized nightly coverage mutation conform planted lint format docs optimum-figures profile-figures gap-figures texts generated kernel kernel-mutants kernel-driver-mutants clean

install: .venv/installed

.venv/base: pyproject.toml constraints.txt
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

.venv/installed: .venv/base
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	touch $@
	$(BIN)/python -m carp_optimum

.venv/mutation: .venv/installed
	$(BIN)/python -m pip install --quiet --editable '.[mutation]'
	touch $@

# Compile what bounds and the planner run, if a source has changed: a minute, in place of some test's or the demo's.
compiled: install
	$(BIN)/python -m carp_optimum

# The first time, the demo compiles the planner.
demo: .venv/base
	$(BIN)/carproof demo

lint: install
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy

format: install
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

# The documentation site, in build/site: open build/site/index.html.
docs: install
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet

# In a minute or two: lint, types, and the fastest tests of every package, with few examples.
quick: install
	$(MAKE) --jobs 2 lint quick-tests

QUICK := tests/spec tests/reference tests/optimized/test_limits.py tests/optimized/neighbourhood/test_sorting.py \
    tests/verify/test_certificate.py tests/verify/lemmas/test_evidence.py \
    $(addprefix tests/verify/optimum/test_,encoding.py joint_search.py) \
    $(addprefix tests/oracle/,judging/test_rules.py generate formats/test_networkx_graphs.py viewer/test_view.py) \
    tests/experiments/test_statistics.py tests/experiments/test_page.py tests/test_frozen.py tests/test_house.py tests/test_programs.py \
    tests/test_surface.py

quick-tests: install
	HYPOTHESIS_PROFILE=quick $(BIN)/pytest -q -m 'not nightly and not ci' $(QUICK)

# Lint, types, and the tests that are marked neither ci nor nightly, with 60 examples where hypothesis draws.
test: checked
	$(BIN)/pytest -m 'not nightly and not ci' --numprocesses 2 --dist worksteal

# Lint and types on one core, and compilation on the other.
checked: install
	$(MAKE) --jobs 2 lint compiled

# Also the tests marked ci, with 200 examples, and the kernel, which takes Coq a minute: what the gate in .ci/run needs.
ci: checked kernel
	HYPOTHESIS_PROFILE=ci $(BIN)/pytest -m 'not nightly' --numprocesses 2 --dist worksteal

# All tests, also those marked nightly, with 1,000 examples.
thorough: compiled
	HYPOTHESIS_PROFILE=thorough $(BIN)/pytest --numprocesses 2 --dist worksteal

# How fast the optimised planner is, beside C++ written by hand and the reference; needs g++.
bench: install
	$(BIN)/pytest -q -s tests/bench/bench_speed.py

# A hundred thousand requests of four clients to servers that keep fleets, each answer judged: 41 minutes
# at the least priority beside other work on two cores; the clients took 12 minutes of processor time.
# SEED decides what is asked; after MINUTES the clients stop.
soak: install
	nice -n 19 $(BIN)/python -m tests.bench.soak $(or $(REQUESTS),100000) $(or $(SEED),0) $(or $(MINUTES),1440)

# What a fleet in memory costs beside the compiled core, and how fast documents of large fleets are read.
bench-fleet: install
	$(BIN)/python -m tests.bench.bench_fleet 100 1000 3000
	$(BIN)/python -m tests.bench.bench_documents 3000 5000

# Measure how long the search for an optimum takes, and put the table into docs/results/optima.md; takes up to half an hour.
optimum-figures: install
	$(BIN)/python -m carp_experiments.measuring.optimum_table

# Measure where the time goes for 100, 1,000 and 10,000 robots, and put the table into docs/results/profile.md: some minutes.
profile-figures: install
	$(BIN)/python -m carp_experiments.measuring.where_time_goes

# Measure how far polished plans are above the bound on the paper's maps, and put the tables into docs/results/gaps.md and bounds.md: four
# hours. `python -m carp_experiments.measuring.gap_table --seeds 2` measures two assignments a map, `--quick` prints the tables of a few seconds.
gap-figures: install
	$(BIN)/python -m carp_experiments.measuring.gap_table

# A run of the paper in full, `make paper-quality`; it continues where its store ends, and writes tables and figures to `report`.
# Seconds of processor time on a machine with 2 cores: quality 11,900; time 200; reuse 160; gap 550; related 420; polish, for 861 of
# its 2,100 cases, 18,800; conventions, for 12 of 200, 1,680; nearest, for 84 of 200, 2,280; remaining, for 84 of 200, 790; neighbours 180.
PAPER := paper-quality paper-time paper-reuse paper-gap paper-related paper-polish paper-conventions paper-nearest \
    paper-remaining paper-neighbours
.PHONY: $(PAPER) paper-recomputed
$(PAPER): paper-%: install
	nice $(BIN)/carproof experiment $* --store $*.sqlite --workers 2 --report report

# Compute 50 random cases of each stored run again with the reference planner; continues where it stopped. Seconds of processor time:
# gap 1,400; reuse 250; related 1,200; time 420; quality 730; neighbours 600; nearest 170; polish 1,040.
paper-recomputed: install
	for name in gap reuse related time quality neighbours nearest polish; do \
	    xz -dkc experiments/results/$$name.sqlite.xz > $$name.stored && \
	    nice $(BIN)/carproof experiment recomputed $$name $$name.stored --store $$name.again --workers 2 || exit 1; \
	done

# Let the kernel and Python read the same million texts, nearly right ones; continues where the store ends.
texts: install kernel
	nice $(BIN)/carproof experiment texts --store texts.sqlite

generated: compiled
	$(BIN)/python -m carp_spec.documents.schema
	$(BIN)/python -m tests.oracle.test_readme
	$(BIN)/python -m tests.vectors.writing
	$(BIN)/python -m carproof.protocol.ops.published
	$(BIN)/python -m carproof.viewer.samples
	$(BIN)/python -m tests.test_surface

# Ask the reference questions of the paper's size, and write digests of its answers, with which the gate compares the
# compiled planner's: about a quarter of an hour.
paper-sized: compiled
	$(BIN)/python -m tests.optimized.paper_sized

# All tests with 50,000 examples, and the mutants of the kernel's driver: hours.
nightly: install kernel-driver-mutants
	HYPOTHESIS_PROFILE=nightly $(BIN)/pytest

# The long run of the planners in other languages: 2,000 random cases each.
conform: install
	$(BIN)/python -m tests.foreign.building
	for language in cpp go; do \
	    $(BIN)/carproof conform --level context-optimal --examples 2000 -- .venv/foreign/$$language || exit 1; \
	done

# When `carproof conform` finds bugs that show only beyond a size or a number: the table of docs/results/conform.md.
planted: compiled
	nice $(BIN)/python -m tests.oracle.conform.asking.planted

# Every line and branch of the specification and the reference, by their own tests, the vectors, and the tests of what commands, ops and
# public functions refuse; then of the compiled planner, run uncompiled: ten minutes on two cores, with 20 seconds a test, and without
# tests that start processes of their own or measure times.
SPECIFIED := tests/spec tests/reference tests/verify/query $(addprefix tests/verify/test_,vectors.py documents.py) \
    $(addprefix tests/oracle/api/test_,assign.py malformed_values.py public_face.py) \
    tests/oracle/entry/test_refusals.py $(addprefix tests/oracle/protocol/test_,ops.py schema.py)

coverage: install
	$(BIN)/pytest -m 'not nightly and not ci' --cov --cov-fail-under=100 $(SPECIFIED)
	NUMBA_DISABLE_JIT=1 HYPOTHESIS_PROFILE=quick $(BIN)/pytest -n 2 -p tests.optimized.within_seconds -W ignore::RuntimeWarning \
	    --cov --cov-config=tests/optimized/coverage.toml tests/optimized tests/verify/query $(addprefix tests/oracle/,api execution judging) \
	    -k "not paper_sized and not every_small and not compiling and not uncompiled and not bounds and not planted \
	    and not the_time and not undecided_search and not counted_once"

# Break the code in one place after the other, each mutant in a process forked for it, and list what no test noticed:
# of the checkers that call something proved, verified or conforming, of the specification and the reference, and of the
# compiled planner's reuse, run uncompiled. `make mutation-carp_spec` for one package; tests/mutation/survivors.md
# explains what is left.
mutation: mutation-trusted mutation-carp_spec mutation-carp_reference mutation-carp_optimized

mutation-trusted: .venv/mutation
	nice $(BIN)/python -m tests.mutation.checkers

mutation-carp_optimized: .venv/mutation
	nice $(BIN)/python -m tests.mutation.planner

mutation-%: .venv/mutation
	nice $(BIN)/python -m tests.mutation.specified $*

# Check the proofs of the kernel, print what each theorem rests on, and make build/kernel/carproof-kernel: Coq and OCaml.
kernel:
	@$(MAKE) --no-print-directory -C verify/kernel -j 2

# Plant errors in the kernel's definitions; each must break a proof.
kernel-mutants: kernel
	$(PYTHON) -m tests.verify.kernel.mutants

# Break the kernel's driver in one place after the other, and list what no test notices: hours.
# tests/verify/kernel/driver_survivors.md explains what is left.
kernel-driver-mutants: install kernel
	nice $(BIN)/python -m tests.verify.kernel.driver_mutants

clean:
	rm -rf .venv build/kernel
