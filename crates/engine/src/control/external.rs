//! Controllers outside the core: called at their samples with the signals they want, held to what they declared.
//! Whatever goes wrong in one ends its run with its name, the time and the value.

use super::error::ControlError;
use super::spec::BlockSpec;
use std::collections::HashMap;
use std::fmt::Debug;

/// A controller that someone else wrote; one of its own for every run.
pub trait External: Send + Debug {
    /// Called once, before the first `step`.
    ///
    /// # Errors
    /// What went wrong, in words that follow the controller's name.
    fn reset(&mut self) -> Result<(), String>;

    /// The outputs for the inputs at a time since the start of the run \[s\], SI units, in the order of its block.
    ///
    /// # Errors
    /// As `reset`.
    fn step(&mut self, time: f64, inputs: &[f64]) -> Result<Vec<f64>, String>;
}

/// External controllers by the names of their blocks.
pub type Externals = HashMap<String, Box<dyn External>>;

/// One in a run.
#[derive(Debug)]
pub(super) struct Attached {
    pub name: String,
    outputs: Vec<String>,
    controller: Box<dyn External>,
    begun: bool,
}

impl Attached {
    /// Every external block with its controller.
    pub fn all(blocks: &[BlockSpec], mut given: Externals) -> Result<Vec<Self>, ControlError> {
        let external = |block: &BlockSpec| {
            let BlockSpec::External { name, outputs, .. } = block else { return None };
            let (name, outputs) = (name.clone(), outputs.clone());
            Some(match given.remove(&name) {
                Some(controller) => Ok(Self { name, outputs, controller, begun: false }),
                None => Err(ControlError::ExternalMissing { name }),
            })
        };
        let attached = blocks.iter().filter_map(external).collect::<Result<_, _>>()?;
        match given.into_keys().min() {
            Some(name) => Err(ControlError::ExternalUnknown { name }),
            None => Ok(attached),
        }
    }

    pub fn step(&mut self, time: f64, inputs: &[f64], out: &mut [f64]) -> Result<(), ControlError> {
        let begun = if self.begun { Ok(()) } else { self.controller.reset() };
        self.begun = true;
        let failed = |text| ControlError::External { name: self.name.clone(), text };
        let given = begun.and_then(|()| self.controller.step(time, inputs)).map_err(failed)?;
        if given.len() != out.len() {
            let (name, expected) = (self.name.clone(), self.outputs.join(", "));
            return Err(ControlError::ExternalSize { name, given: given.len(), wanted: out.len(), expected });
        }
        out.copy_from_slice(&given);
        match given.iter().zip(&self.outputs).find(|(y, _)| !y.is_finite()) {
            Some((&value, output)) => {
                Err(ControlError::ExternalValue { name: self.name.clone(), output: output.clone(), value })
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ControlSpec, Controller};
    use super::*;
    use std::sync::{Arc, Mutex};

    type Calls = Arc<Mutex<Vec<(f64, Vec<f64>)>>>;

    /// Gives the sum of its inputs and twice that, or what is wrong about the fifth call.
    #[derive(Debug)]
    struct Sum {
        calls: Calls,
        wrong: Option<Result<Vec<f64>, String>>,
    }

    impl External for Sum {
        fn reset(&mut self) -> Result<(), String> {
            self.calls.lock().unwrap().push((-1.0, Vec::new()));
            Ok(())
        }
        fn step(&mut self, time: f64, inputs: &[f64]) -> Result<Vec<f64>, String> {
            let mut calls = self.calls.lock().unwrap();
            calls.push((time, inputs.to_vec()));
            let sum: f64 = inputs.iter().sum();
            if calls.len() > 5 {
                self.wrong.clone().unwrap_or(Ok(vec![sum, 2.0 * sum]))
            } else {
                Ok(vec![sum, 2.0 * sum])
            }
        }
    }

    fn spec() -> ControlSpec {
        let json = r#"{"sample_time": 0.001, "measurements": ["v", "w"], "blocks": [
            {"kind": "external", "name": "Mine", "inputs": ["v", "w"], "outputs": ["a", "b"], "samples": 2},
            {"kind": "sum", "name": "out", "terms": [{"signal": "b"}, {"signal": "a", "gain": 0.5}]}],
            "commands": [{"target": "motor", "signal": "out"}]}"#;
        serde_json::from_str(json).unwrap()
    }

    fn controller(wrong: Option<Result<Vec<f64>, String>>) -> (Controller, Calls) {
        let calls = Calls::default();
        let external: Box<dyn External> = Box::new(Sum { calls: Arc::clone(&calls), wrong });
        (Controller::with(&spec(), [("Mine".to_string(), external)].into()).unwrap(), calls)
    }

    #[test]
    fn it_is_called_at_its_samples_and_held_in_between() {
        let (mut c, calls) = controller(None);
        c.reset(&[1.0, 2.0]).unwrap();
        assert_eq!(c.commands(), [7.5]);
        c.step(&[3.0, 3.0]).unwrap();
        assert_eq!(c.commands(), [7.5]);
        c.step(&[4.0, 4.0]).unwrap();
        assert_eq!(c.commands(), [20.0]);
        let expected = [(-1.0, vec![]), (0.0, vec![1.0, 2.0]), (0.002, vec![4.0, 4.0])];
        assert_eq!(*calls.lock().unwrap(), expected);
    }

    #[test]
    fn what_goes_wrong_carries_its_name_and_the_value() {
        for (wrong, words) in [
            (Err("raised ValueError: no".into()), "`Mine` raised ValueError: no"),
            (Ok(vec![1.0]), "`Mine` gives 1 commands, 2 are declared (a, b)"),
            (Ok(vec![1.0, f64::NAN]), "`Mine` gives NaN for `b`"),
            (Ok(vec![f64::INFINITY, 0.0]), "`Mine` gives inf for `a`"),
        ] {
            let (mut c, _) = controller(Some(wrong));
            c.reset(&[1.0, 2.0]).unwrap();
            let ended = (1..20).find_map(|_| c.step(&[1.0, 2.0]).err()).unwrap().to_string();
            assert!(ended.starts_with(words), "{ended}");
        }
    }

    #[test]
    fn a_block_without_its_controller_is_refused_and_one_without_its_block() {
        assert!(Controller::compile(&spec()).unwrap_err().to_string().contains("`Mine`"));
        let (calls, wrong) = (Calls::default(), None);
        let both: Externals = ["Mine", "Yours"]
            .map(|name| {
                let external: Box<dyn External> = Box::new(Sum { calls: Arc::clone(&calls), wrong: wrong.clone() });
                (name.to_string(), external)
            })
            .into();
        assert!(Controller::with(&spec(), both).unwrap_err().to_string().contains("`Yours`"));
    }

    #[test]
    fn steady_states_and_linear_models_refuse_it() {
        let (c, _) = controller(None);
        let diagram = c.diagram();
        assert!(diagram.is_linear().unwrap_err().to_string().contains("`Mine`"));
        let mut memory = diagram.memory::<f64>();
        assert!(diagram.settle(&mut memory, &[1.0, 2.0], &[]).unwrap_err().to_string().contains("StateSpace"));
    }
}
