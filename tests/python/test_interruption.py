"""Runs that are stopped: by a callback, an exception, Ctrl-C; and runs side by side."""

import os
import signal
import subprocess
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
from prototypes import NumpyStvk
from waiting import wait_until

import drape
from conftest import with_membrane


class Luck(Exception):
    pass


def test_a_callback_stops_and_refines(experiment):
    stopped = experiment.run(on_iteration=lambda i: "stop", progress=False)
    assert len(stopped.iterations) == 1 and not stopped.complete
    assert stopped["pcs"].levels[0].status == "cancelled"
    refined = experiment.run(on_iteration=lambda i: "refine" if i.level == 0 else None, progress=False)
    assert [level.status for level in refined["pcs"].levels] == ["refined_early_on_request", "converged"]
    assert refined["pcs"].levels[0].iterations == 1


def test_callbacks_see_levels_and_know_the_method(experiment):
    iterations, levels = [], []
    experiment.run(methods=["pcs", "cascadic"], on_iteration=iterations.append, on_level=levels.append, progress=False)
    assert [(level.method, level.level) for level in levels] == [("pcs", 0), ("pcs", 1), ("cascadic", 0), ("cascadic", 1)]
    assert [level.status for level in levels[:2]] == ["converged", "converged"]
    assert levels[1].x.shape == (121, 3) and levels[1].iterations > 0
    for method in ("pcs", "cascadic"):
        assert sum(i.method == method for i in iterations) == sum(l.iterations for l in levels if l.method == method)
    assert "cascadic" in repr(iterations[-1])


def test_states_of_callbacks_may_be_kept(experiment):
    kept = []
    result = experiment.run(on_iteration=lambda i: kept.append(i.x), progress=False)
    assert kept[-1].tobytes() == result["pcs"].levels[-1].x.tobytes()
    assert kept[0].tobytes() != kept[1].tobytes()


@pytest.mark.parametrize("where", ["on_iteration", "on_level"])
def test_an_exception_in_a_callback_is_raised(experiment, where, tmp_path, command):
    def fail(_):
        raise Luck("out of luck")

    with pytest.raises(Luck, match="out of luck"):
        experiment.run(out=tmp_path / "r", report=False, progress=False, **{where: fail})
    ended = subprocess.run([command, "run", "--resume", tmp_path / "r", "-q", "--no-report"])
    assert ended.returncode == 0
    plain = experiment.run(progress=False)["pcs"].levels[-1].x
    assert drape.read_run(tmp_path / "r")["pcs"].levels[-1].x.tobytes() == plain.tobytes()


def test_ctrl_c_in_a_prototype_leaves_its_method_to_be_resumed(small, tmp_path):
    class Interrupted(NumpyStvk):
        due = False

        def gradient(self, x, rest):
            if Interrupted.due:
                Interrupted.due = False
                raise KeyboardInterrupt
            return super().gradient(x, rest)

    def interrupt(_):
        Interrupted.due = True

    experiment = drape.Experiment(with_membrane(small, Interrupted))
    folder, methods = tmp_path / "r", ["pcs", "newton"]
    with pytest.raises(KeyboardInterrupt):
        experiment.run(methods=methods, out=folder, report=False, progress=False, on_level=interrupt)
    resumed = drape.resume(folder, report=False, progress=False)
    plain = experiment.run(methods=methods, progress=False)
    for method in methods:
        assert resumed[method].status == plain[method].status
        assert resumed[method].levels[-1].x.tobytes() == plain[method].levels[-1].x.tobytes()


def test_a_run_is_resumed_to_the_same_bits(small, tmp_path):
    class Own(NumpyStvk):
        """A prototype, which the command does not know."""

    experiment, folder, seen = drape.Experiment(with_membrane(small, Own)), tmp_path / "r", []
    experiment.run(out=folder, report=False, progress=False, on_iteration=lambda i: "stop" if i.level == 1 else None)
    assert not drape.read_run(folder).complete
    resumed = drape.resume(folder, report=False, progress=False, on_level=seen.append)
    assert resumed.complete and [level.level for level in seen] == [1]
    plain = experiment.run(progress=False)
    assert resumed["pcs"].levels[-1].x.tobytes() == plain["pcs"].levels[-1].x.tobytes()
    again = drape.resume(folder, on_level=seen.append, progress=False)  # complete: nothing runs
    assert again.complete and len(seen) == 1
    (folder / resumed["pcs"].levels[-1].mesh).write_text("")
    with pytest.raises(RuntimeError, match="files are damaged or missing"):
        drape.resume(folder)
    with pytest.raises(RuntimeError, match="holds no run"):
        drape.resume(tmp_path)


def test_what_a_callback_may_not_be_or_return(experiment):
    with pytest.raises(TypeError, match="on_iteration must be a function"):
        experiment.run(on_iteration=7, progress=False)
    with pytest.raises(ValueError, match="must return None"):
        experiment.run(on_iteration=lambda i: "on", progress=False)


def test_ctrl_c_raises_keyboard_interrupt(small, tmp_path):
    small["cloth"].update(columns=20, rows=20)
    small["levels"] = 3
    small["newton"] = {"force_tolerance": 1e-300, "step_size": 1e-3, "step_growth": 1, "max_steps": 10**8}  # ends by Ctrl-C
    experiment, steps = drape.Experiment(small), tmp_path / "r/iterations.csv"

    def interrupt():
        try:
            wait_until("the run makes steps", lambda: steps.exists() and steps.read_text().count("\n") > 5)
        finally:
            os.kill(os.getpid(), signal.SIGINT)

    other = threading.Thread(target=interrupt)
    other.start()
    with pytest.raises(KeyboardInterrupt):
        experiment.run(out=steps.parent, report=False, progress=False)
    other.join()
    assert steps.read_text().count("\n") > 5
    drape.Experiment(small).check()


def test_two_runs_in_two_threads(small):
    alone = drape.Experiment(small).run(methods=["all"], progress=False)

    def run(_):
        return drape.Experiment(small).run(methods=["all"], progress=False, on_iteration=lambda i: None)

    with ThreadPoolExecutor(2) as threads:
        for result in threads.map(run, range(2)):
            for method in alone.methods:
                assert result[method].levels[-1].x.tobytes() == alone[method].levels[-1].x.tobytes()
