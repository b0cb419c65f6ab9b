//! Controllers written in Python: the interpreter is taken for their calls alone, the rest of the run does without.
//! An exception becomes the end of the run, in words.

use klingel_engine::control::{External, Externals};
use pyo3::prelude::*;
use std::collections::HashMap;

/// An object with `reset()` and `step(time, inputs) -> outputs`.
#[derive(Debug)]
struct PythonController(Py<PyAny>);

/// The controllers as the core takes them.
pub fn boxed(given: HashMap<String, Py<PyAny>>) -> Externals {
    let boxed = |object| -> Box<dyn External> { Box::new(PythonController(object)) };
    given.into_iter().map(|(name, object)| (name, boxed(object))).collect()
}

impl External for PythonController {
    fn reset(&mut self) -> Result<(), String> {
        Python::attach(|py| self.0.call_method0(py, "reset").map(|_| ()).map_err(|e| raised(py, &e)))
    }

    fn step(&mut self, time: f64, inputs: &[f64]) -> Result<Vec<f64>, String> {
        Python::attach(|py| {
            let given = self.0.call_method1(py, "step", (time, inputs)).map_err(|e| raised(py, &e))?;
            given.extract(py).map_err(|_| format!("gives {}; return a sequence of numbers", shown(given.bind(py))))
        })
    }
}

fn shown(value: &Bound<'_, PyAny>) -> String {
    value.repr().map_or_else(|_| "what cannot be shown".into(), |text| text.to_string())
}

/// "raised ValueError: text".
fn raised(py: Python<'_>, error: &PyErr) -> String {
    let kind = error.get_type(py).name().map_or_else(|_| "an exception".into(), |name| name.to_string());
    let text = error.value(py).to_string();
    if text.is_empty() { format!("raised {kind}") } else { format!("raised {kind}: {text}") }
}
