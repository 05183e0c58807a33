"""The Debug Adapter Protocol: conversion between an editor and ``workbench.clause_debugging``."""
