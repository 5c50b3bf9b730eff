"""For learning: ``gymnasium.make("drystone/Wall-v0")`` (docs/evidence/learning.md).

Importing this room registers the environment, and needs the extra ``rl``; nothing else of the
package imports it.  The policy that was trained with it needs no extra
(:mod:`drystone.selection.policies.learned`).
"""

from drystone.errors import UsageError

try:
    import gymnasium
except ImportError as error:
    what = "gymnasium is not installed, and walls for reinforcement learning are its environments."
    cure = "Install it with `pip install 'drystone[rl]'`."
    raise UsageError("E150", what, where="drystone_lab.rl", cure=cure) from error

ENVIRONMENT = "drystone/Wall-v0"

gymnasium.register(ENVIRONMENT, entry_point="drystone_lab.rl.env:WallEnv")
