"""Scenes of tunnels are run, shortened: half and full ones, in one soil and in two layers."""

from scene_runs import TUNNELS, check_scene

if __name__ == "__main__":
    for name, short in TUNNELS.items():
        check_scene(name, short)
