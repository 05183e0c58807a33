"""The simulated world: scene, objects, arms, grippers, motion, pictures. Only this package uses MuJoCo."""
