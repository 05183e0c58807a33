"""The simulated world: scene, objects, arms, grippers, motion, pictures; the only user of MuJoCo."""
