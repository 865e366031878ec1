# Runs and tests dynsim_ros from its source tree; needs GNU make and Python 3.10 to 3.13, nothing else.
# `make help` lists the targets. Everything that is set up lies in .venv, made on first use by tools/set_up.

VENV := .venv
SETTINGS := setup.py setup.cfg pyproject.toml tools/set_up
PYTHON ?=
export PYTHON
export ROS_AUTOMATIC_DISCOVERY_RANGE ?= LOCALHOST

# Quick discovery by loopback alone, unless there are settings of the user's own or other machines to reach.
OWN_DISCOVERY := $(FASTRTPS_DEFAULT_PROFILES_FILE)$(FASTDDS_DEFAULT_PROFILES_FILE)$(ROS_STATIC_PEERS)$(ROS_DISCOVERY_SERVER)
ifeq ($(ROS_AUTOMATIC_DISCOVERY_RANGE)$(strip $(OWN_DISCOVERY)),LOCALHOST)
export FASTRTPS_DEFAULT_PROFILES_FILE := $(CURDIR)/config/fastdds_one_machine.xml
endif

# The environment is made anew where it stands for another place or another ROS, or has lost its python.
export MADE_FOR := $(if $(filter jazzy,$(ROS_DISTRO)),jazzy,wheels) $(CURDIR)
ifneq ($(MADE_FOR)/$(wildcard $(VENV)/bin/python),$(file <$(VENV)/made_for)/$(VENV)/bin/python)
STALE := stale
endif

# What `make run` hands to the node: only what was asked for, the node knows its own defaults.
PARAMETERS = -p record.enable:=true \
	$(if $(SCENE),-p 'scene:=$(SCENE)') $(if $(DURATION),-p 'duration:=$(DURATION)')

.DELETE_ON_ERROR:
.PHONY: help run view live test test-browser test-readers bench bench-quick bench-stability \
	bench-skipping bench-instructions bench-node bench-bag bench-view fuzz-bag rerun-grid soak lint clean stale

help:
	@echo 'make run     simulate live on ROS 2 and record, until Ctrl-C; bags go to runs/'
	@echo '               DURATION=10                 stop after 10 s of simulated time'
	@echo '               SCENE=spinning_box          a scene of scenes/, or the path of a YAML file'
	@echo "               ARGS='-p rate:=200.0'       more ROS arguments for the node"
	@echo 'make view    show the newest recorded run in the browser; FILE=runs/some.mcap: that one'
	@echo 'make live    show and steer in the browser what `make run` simulates in another terminal'
	@echo "               ARGS='--node /lab/dynsim'   more options; \`tools/in_venv view --help\` has all"
	@echo "make test    run the test suite            ARGS='-k bag -x' hands options to pytest"
	@echo 'make test-browser   only the tests that open the viewer in a Chromium, which has to be there'
	@echo 'make test-readers   only the tests that open bags with Rerun and with the readers of Foxglove (needs npm)'
	@echo 'make bench   measure run time against error (forty minutes with ARGS=--rounds=8); tables and plot go to benchmarks/'
	@echo '               ARGS="--scenes S2 --peers heyoka --output /tmp"'
	@echo 'make bench-quick   the main scenes against the fastest engines, in less than three minutes'
	@echo 'make bench-stability   every method and the engines over twelve decades of parameters; to benchmarks/'
	@echo 'make bench-skipping    what a step costs with each term of a scene removed; to benchmarks/'
	@echo 'make bench-instructions   run time against error as counts of instructions (needs valgrind); to benchmarks/'
	@echo 'make bench-node   what the node costs beside a naive one (ten minutes; ARGS=--quick: two); to benchmarks/'
	@echo 'make bench-bag    a million messages written, read, recovered, and kill -9 in a loop; to benchmarks/'
	@echo 'make bench-view   how soon and how smoothly a run of 60 s at 1 kHz is shown; to benchmarks/'
	@echo 'make fuzz-bag     a thousand bags damaged at random and recovered, of each compression'
	@echo 'make rerun-grid   every scene, method and kind of commands lived again, and a live run of a minute'
	@echo 'make soak    ten minutes of the node at 1 kHz with two subscribers and 100 commands a second'
	@echo 'make lint    check the style'
	@echo 'make clean   remove .venv, caches and build output; recorded runs stay'
	@echo
	@echo 'The first run makes .venv: with the sourced ROS 2 Jazzy, else with its packages from PyPI.'
	@echo 'PYTHON=/path/to/python3.12 chooses the Python (3.10 to 3.13) that .venv is made from.'

run: $(VENV)/ready
	@exec tools/in_venv sim_node --status --ros-args $(PARAMETERS) $(ARGS)

view: $(VENV)/ready
	@exec tools/in_venv view $(if $(FILE),'$(FILE)',--newest) $(ARGS)

live: $(VENV)/ready
	@exec tools/in_venv view --live $(ARGS)

test: $(VENV)/ready_for_tests
	@exec tools/in_venv python -m pytest -n 2 --dist loadfile $(ARGS)

test-browser: $(VENV)/ready_for_tests
	@tools/in_venv python test/chromium.py
	@exec tools/in_venv python -m pytest test/browser $(ARGS)

test-readers: $(VENV)/ready_for_tests $(VENV)/readers/ready
	@exec tools/in_venv python -m pytest test/readers $(ARGS)

bench: $(VENV)/ready_for_benchmarks
	@tools/in_venv python benchmarks/work_precision.py $(ARGS)
	@tools/in_venv python benchmarks/c_speed.py

bench-quick: $(VENV)/ready_for_benchmarks
	@exec tools/in_venv python benchmarks/work_precision.py --quick $(ARGS)

bench-stability: $(VENV)/ready_for_benchmarks
	@exec tools/in_venv python benchmarks/stability.py --long $(ARGS)

bench-skipping: $(VENV)/ready_for_benchmarks
	@exec tools/in_venv python benchmarks/skipping.py $(ARGS)

bench-instructions: $(VENV)/ready_for_benchmarks
	@exec tools/in_venv python benchmarks/instructions.py $(ARGS)

bench-node: $(VENV)/ready_for_benchmarks
	@exec tools/in_venv python benchmarks/node.py $(ARGS)

bench-bag: $(VENV)/ready_for_tests
	@exec tools/in_venv python benchmarks/bag.py $(ARGS)

bench-view: $(VENV)/ready_for_tests
	@exec tools/in_venv python benchmarks/view.py $(ARGS)

fuzz-bag: $(VENV)/ready_for_tests
	@DYNSIM_FUZZ_ROUNDS=1000 exec tools/in_venv python -m pytest test/bag/recovery/test_fuzzed.py --timeout 1200 $(ARGS)

rerun-grid: $(VENV)/ready_for_tests
	@DYNSIM_RERUN_GRID=all exec tools/in_venv python -m pytest --timeout 3600 test/bag/test_rerun_grid.py \
		test/ros/test_rerun_live.py $(ARGS)

soak: $(VENV)/ready
	@exec tools/in_venv python benchmarks/soak.py $(ARGS)

lint: $(VENV)/ready_for_tests
	@tools/in_venv python -m flake8
	@tools/in_venv ruff check --quiet .

clean:
	@rm -rf $(VENV) build dist install log *.egg-info .pytest_cache .ruff_cache
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/ready: $(SETTINGS) $(STALE)
	@tools/set_up $(VENV)
	@touch $@

$(VENV)/ready_for_tests: $(SETTINGS) $(STALE)
	@tools/set_up $(VENV) test
	@touch $(VENV)/ready $@

$(VENV)/ready_for_benchmarks: $(SETTINGS) $(STALE)
	@tools/set_up $(VENV) bench
	@touch $(VENV)/ready $@

$(VENV)/readers/ready: tools/set_up_readers test/readers/package-lock.json test/readers/requirements.txt \
		$(STALE) | $(VENV)/ready_for_tests
	@tools/set_up_readers $(VENV)/readers
	@touch $@
