"""For learning: ``gymnasium.make("drystone/Wall-v0")`` (docs/evidence/learning.md).

Importing this room registers the environment, and needs the extra ``rl``; nothing else of the
package imports it.  The policy that was trained with it needs no extra
(:mod:`drystone.selection.policies.learned`).
"""

from drystone.errors import extra

ENVIRONMENT = "drystone/Wall-v0"

_gymnasium = extra("gymnasium", "knows walls to learn on", "drystone_lab.rl", "rl", "E150")
_gymnasium.register(ENVIRONMENT, entry_point="drystone_lab.rl.env:WallEnv")
