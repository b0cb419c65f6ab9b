# Set-up, study, tests and checks of a checkout; everything lands in .venv/ and target/.
# Needs python3 >= 3.11, cargo, make and a C linker; `make help` lists the targets.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
OUT    ?= out/perez2004

RUST_SOURCES := $(shell find crates -type f -not -name '*.md') Cargo.toml Cargo.lock

# Clippy, cargo test and the extension agree on one interpreter.
export PYO3_PYTHON := $(CURDIR)/$(BIN)/python
export VIRTUAL_ENV := $(CURDIR)/$(VENV)

.DEFAULT_GOAL := help
.PHONY: help build study test test-rust test-python validate lint format bench docs-check clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## /{printf "  %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

build: $(VENV)/.extension ## set up .venv and build the extension

study: build ## run the study of Perez et al. 2004 into out/perez2004 (OUT=DIR to change)
	$(BIN)/klingel study perez2004 --out $(OUT)

test: lint ## format, lint, types, Rust tests, Python tests
	@$(MAKE) --no-print-directory --jobs=2 test-rust test-python

test-rust: $(VENV)/.packages ## Rust tests
	cargo test --workspace --locked --quiet

test-python: build ## Python tests and doctests
	$(BIN)/python -m pytest

validate: build ## every validation case; writes docs/validation.md
	$(BIN)/python -m validation

lint: build ## rustfmt, clippy, ruff, mypy
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
	$(BIN)/ruff format --check python tests validation benches examples
	$(BIN)/ruff check python tests validation benches examples
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest klingel._core

format: $(VENV)/.packages ## format Rust and Python
	cargo fmt --all
	$(BIN)/ruff format python tests validation benches examples
	$(BIN)/ruff check --fix python tests validation benches examples

bench: build ## benchmarks: Rust; linear models and root loci
	cargo bench --workspace --locked
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benches/linear.py

docs-check: $(VENV)/.packages ## rustdoc without warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked --quiet

clean: ## remove .venv and target
	rm -rf $(VENV) target

# Stamp files: an editable install would silently keep running an old extension.
$(VENV)/.packages: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	  || { echo "klingel needs python3 >= 3.11, but $(PYTHON) is $$($(PYTHON) --version 2>&1); set PYTHON=..."; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check uv==0.13.9 maturin==1.16.0
	$(BIN)/uv pip install --quiet --compile-bytecode --python $(BIN)/python -r pyproject.toml --group dev
	@touch $@

$(VENV)/.extension: $(VENV)/.packages $(RUST_SOURCES)
	@touch $@.begun  # sources edited while it builds are newer than this
	$(BIN)/maturin develop --release --locked --uv --quiet
	@mv $@.begun $@
