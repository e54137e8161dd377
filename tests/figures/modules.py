"""Checks what the modules and scripts of benchmarks/ decide, of the sources themselves: runs no study and writes nothing."""

import re
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))
import records  # noqa: E402


def text_of(path):
    return (ROOT / path).read_text()


def script(name):
    return SourceFileLoader(name, str(ROOT / "benchmarks" / name)).load_module()


def stamps_tell_other_work():
    """A stamp tells work beside the study's own runs, and that only."""
    def words(runs, threads, before, after):
        stamp = {"commit": "a", "threads": threads, "runs_at_a_time": runs, "load_before": before, "load_after": after}
        records.stamps = lambda: {"build": "a", "records": {"r": stamp}}
        return records.conditions("r")

    alone = words(1, 2, 0.2, 2.1) + words(2, 1, 2.0, 2.1)  # before: what the last study left behind
    assert "beside" not in alone, alone
    for beside in (words(1, 2, 1.0, 2.1), words(1, 2, 0.2, 3.1), words(2, 1, 0.2, 4.5)):
        assert "beside other work" in beside, beside


def twins_are_one_experiment():
    """Scenes that share one record differ in names and methods alone, and the study of all scenes has them once."""
    def experiment(name):
        text = re.sub(r"^methods:\n(?:  .*\n)+", "", text_of(f"configs/{name}.yaml"), flags=re.M)
        return [line for line in text.splitlines() if not re.match(r"#|name:|description:|reference:", line)]

    scenes = text_of("configs/sweeps/scenes.yaml")
    assert records.TWINS
    for second, first in records.TWINS.items():
        assert len(experiment(first)) > 10 and experiment(second) == experiment(first), f"{second} is not {first}"
        assert f"../{second}.yaml" not in scenes, second


def the_version_leaves_the_same_aside():
    """A change that makes no study old may not make a build dirty, which run_studies refuses."""
    of_version = re.findall(r'"(:\(exclude\)[^"]+)"', text_of("core/write_version.cmake"))
    assert sorted(of_version) == sorted(script("run_studies").ASIDE), of_version


def scenes_that_did_not_run_are_not_called_unfinished():
    table1 = script("table1")
    others = table1.left_out(["sphere"], [(None, {"experiment": "sphere"}), (None, {"experiment": "cube"})])
    assert others == {"Not finished": ["cube"], "Not run": ["materials_6", "bunny", "armadillo", "sphere_fine"]}, others
    assert "\n## Not finished\n\n- cube\n\n## Not run\n\n- materials_6\n" in table1.markdown({}, others)


stamps_tell_other_work()
twins_are_one_experiment()
the_version_leaves_the_same_aside()
scenes_that_did_not_run_are_not_called_unfinished()
