"""One rank of an optimisation fails."""

import pytest
from tests.extensions.optimization.test_optimization import FEWER, GOAL, RIGID, VARIABLES
from tests.system.test_failing_ranks import PLANE, check_end, ended, failures

pytestmark = [pytest.mark.ranks, pytest.mark.nightly]

COMMAND = (["optimize", "design.toml"], {"pair.toml": PLANE, "design.toml": RIGID + VARIABLES + GOAL + FEWER})
STAGES = {
    "reading a design": "extensions.optimization.optimize:load_design",
    "a design's run": "runs.one_run:solved",
    "keeping a run": "runs.lines:append",
    "choosing": "extensions.optimization.optimize:chosen",
}
# Every rank comes to them; a run that fails is a design without numbers.
SHARED = {STAGES["a design's run"], STAGES["keeping a run"]}


@pytest.mark.parametrize(("stage", "rank", "how"), failures(STAGES.values(), SHARED, SHARED))
def test_an_error_of_a_rank_ends_all(tmp_path, stage, rank, how):
    """As of the core's commands (tests/system/test_failing_ranks.py)."""
    check_end(ended(tmp_path, COMMAND, stage, rank, how, shared=SHARED), how)
