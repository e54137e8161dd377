# make          install what is needed, configure, build: build/bin/drape
# make setup    install what third_party/apt-packages.txt lists (Debian 12, asks apt-get)
# make demo     run configs/sphere.yaml to 25K vertices by three methods; its values beside the supplement's
# make table1   run every scene of the supplement's Table 1 to its finest level, or go on with it (hours; bunny and
#               armadillo need `make data`); SCENES="sphere cube" LEVELS=3 choose some and fewer levels
# make scenes   run every scene of configs, the supplement's Table 2, by PCS, or go on with it, and write one table of them (needs
#               `make data`; to their finest levels many hours): LEVELS=2 goes to at most so many
# make python   build the Python module: PYTHONPATH=build/python python3 -c "import drape"; `make test` then tests it too
# make test     build and run every test
# make fuzz     fuzz the readers of configs, --set, meshes and checkpoints for FUZZ_SECONDS each (20), or FUZZ_RUNS inputs each;
#               FUZZ_TARGETS="mesh config" chooses some; what ends one is kept in build-fuzz/artifacts
# make extremes run small drapes with parameters at their declared bounds: EXTREMES (500) of them, from the seed EXTREMES_SEED (1)
# make data     fetch scanned meshes and make obstacles of them: data/*.ply (third_party/data/meshes.txt)
# make bench    build and run the benchmarks
# make hard     the hard cases (docs/results/hard-cases.md), and their tables in benchmarks/results; goes on where it was cut
# make pictures the README's pictures, from the runs that `make bench` has left in results/bench_sphere and, of the bunny,
#               those that `make table1` has finished in results/table1/bunny
# make format   check the layout of the sources;  make fix-format  rewrites them
# make lint     static analysis of core and plugins (LINT= a regular expression of paths)
# make clean    remove what was built
#
# PRESET=debug, ci, clang, asan or tsan chooses another of CMakePresets.json; under asan and tsan, the sanitizers,
# `make test` leaves out the long studies (docs/contributing/testing.md).

PRESET ?= release
JOBS ?= $(shell nproc)
LINT ?= (core|plugins)/
BUILD := $(if $(filter release ci,$(PRESET)),build,build-$(PRESET))
SOURCES = $(shell find core plugins tests benchmarks -name '*.cpp' -o -name '*.h')

.PHONY: all setup configure build python demo table1 scenes test fuzz extremes data bench hard pictures format fix-format lint clean
all: build

setup:
	@third_party/setup

configure: setup
	@cmake --preset $(PRESET) --log-level=WARNING >/dev/null

build: configure
	@cmake --build $(BUILD) -j $(JOBS)

python: configure
	@cmake --preset $(PRESET) --log-level=WARNING -DDRAPE_PYTHON=ON >/dev/null
	@cmake --build $(BUILD) -j $(JOBS)

demo: build
	@$(BUILD)/bin/drape run configs/sphere.yaml --levels 3 --method pcs --method cascadic --method newton --out results/sphere --overwrite; ended=$$?; \
	  benchmarks/table1 --show results/sphere; \
	  echo "Open results/sphere/report.html in a browser."; exit $$ended

table1: build
	@benchmarks/table1 --drape $(BUILD)/bin/drape $(if $(SCENES),--scenes "$(SCENES)") $(if $(LEVELS),--levels $(LEVELS))

SCENES_NAME = scenes$(if $(LEVELS),_levels_$(LEVELS))
SCENES_COLUMNS = run,outcome,vertices,steps,seconds,energy,smallest_gap,largest_stretch,intersections,d_H_fit,message
scenes: build
	@$(BUILD)/bin/drape sweep configs/sweeps/scenes.yaml --out results/$(SCENES_NAME) \
	  $(if $(LEVELS),--most-levels $(LEVELS)); ended=$$?; [ $$ended -le 1 ] || exit $$ended; \
	  $(BUILD)/bin/drape table results/$(SCENES_NAME) --columns $(SCENES_COLUMNS) > benchmarks/results/$(SCENES_NAME).md; \
	  cat benchmarks/results/$(SCENES_NAME).md; exit $$ended

test: build
	@ctest --preset $(PRESET) -j $(JOBS)

fuzz: build
	@cmake --preset fuzz --log-level=WARNING -DDRAPE_BUILD=$(abspath $(BUILD)) >/dev/null
	@cmake --build build-fuzz -j $(JOBS)
	@FUZZ_SECONDS=$(FUZZ_SECONDS) FUZZ_RUNS=$(FUZZ_RUNS) JOBS=$(JOBS) tests/fuzz/run build-fuzz $(FUZZ_TARGETS)

extremes: build
	@tests/extremes/run $(BUILD)/bin/drape --count $(or $(EXTREMES),500) --seed $(or $(EXTREMES_SEED),1) --jobs $(JOBS)

data: configure
	@third_party/data/fetch data $(BUILD)

bench: build
	$(BUILD)/bin/drape_bench_kernels --benchmark_out=benchmarks/results/kernels.json --benchmark_out_format=json
	$(BUILD)/bin/drape_bench_linear_solvers benchmarks/results/linear_solvers.json
	-$(BUILD)/bin/drape run configs/pinned_square.yaml --method pcs --method cascadic --method newton --out results/bench_pinned_square --overwrite
	-$(BUILD)/bin/drape run configs/sphere.yaml --method pcs --method cascadic --method newton --out results/bench_sphere --overwrite
	-$(BUILD)/bin/drape run configs/sphere.yaml --method pcs --method newton --set newton.early_refinement_tolerance=1 --out results/bench_sphere_refined_early --overwrite
	$(BUILD)/bin/drape_bench_ratios benchmarks/results/ratios.json $(addprefix results/bench_,pinned_square sphere sphere_refined_early)
	$(BUILD)/bin/drape_bench_changes benchmarks/results/changes.json

HARD = $(sort $(basename $(notdir $(wildcard configs/hard/sweeps/*.yaml))))
hard: build
	@ended=0; for s in $(HARD); do $(BUILD)/bin/drape sweep configs/hard/sweeps/$$s.yaml --out results/hard/$$s || ended=$$?; \
	  [ $$ended -lt 128 ] || exit $$ended; done; configs/hard/write_tables $(BUILD)/bin/drape results/hard benchmarks/results; exit $$ended

pictures: build
	@tests/browser/install $(BUILD)/tests/browser
	DRAPE_BIN=$(BUILD)/bin DRAPE_NODE_MODULES=$(abspath $(BUILD))/tests/browser \
	  node docs/pictures/make.mjs results/bench_sphere/report.html
	$(foreach m,pcs cascadic newton,$(foreach l,0 3,cp results/bench_sphere/pictures/$(m)_l$(l).png docs/pictures/sphere_$(m)_l$(l).png;))
	@for run in $(patsubst %/finished.txt,%,$(wildcard results/table1/bunny/*/finished.txt)); do $(BUILD)/bin/drape report $$run || exit; \
	  for picture in $$run/pictures/$${run##*/}_l[03].png; do to=docs/pictures/bunny_$${picture##*/}; \
	    [ ! -f $$to ] || cp $$picture $$to; done; done

format: setup
	@clang-format --dry-run -Werror $(SOURCES)

fix-format: setup
	@clang-format -i $(SOURCES)

lint: setup
	@cmake --preset lint --log-level=ERROR >/dev/null
	@run-clang-tidy-16 -quiet -p build-lint -j $(JOBS) '$(LINT)'

clean:
	rm -rf build build-wheel build-debug build-clang build-asan build-tsan build-lint build-fuzz
