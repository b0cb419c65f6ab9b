//! The linear model against central differences of the same equations, on the vehicle of `bogie.rs` in a curve.

use crate::bogie::bogie;
use crate::common::Plant;
use crate::drives::induction_drive;
use klingel_engine::pass::Pass;
use klingel_engine::{linearise, steady};
use serde_json::json;

/// How far a state or input of this unit typically departs; differences take a small part of it.
fn scale(unit: &str) -> f64 {
    match unit {
        "m" | "rad" => 1e-3,
        "m/s" | "rad/s" => 0.1,
        "N" => 1e3,
        "N/s" => 1e5,
        "N m" => 1e3,
        "A" | "V" => 10.0,
        "V s" => 0.1,
        "1/m" => 1e-3,
        _ => panic!("no scale for {unit}"),
    }
}

#[test]
fn slopes_are_central_differences() {
    for law in ["linear", "polach", "table"] {
        let mut case = bogie(law, 1.0);
        if law == "polach" {
            // a moved field on one wheel, an induction motor on the other
            case["drives"][0]["field"] = json!({ "resistance": 20.0, "inductance": 12.0, "voltage_max": 300.0 });
            case["drives"].as_array_mut().expect("drives").pop();
            case["induction_drives"] = json!([induction_drive("rear", "right", 50.0)]);
        }
        case["track"] =
            json!({ "start": 0.0, "cant_base": 1.5, "uniform": { "curvature": 1.0 / 400.0, "cant": 0.12 } });
        let plant = Plant::new(&case);
        let m = &plant.model;
        let at = steady(m, None, None).expect("a steady state");
        let linear = linearise(m, None, &at).expect("a linear model");
        let (n, inputs, outputs) = (at.x.len(), at.inputs.len(), linear.outputs.len());
        let mut pass = Pass::<f64>::new(m, None);
        let mut at_place = |column: usize, by: f64| -> Vec<f64> {
            pass.x.copy_from_slice(&at.x);
            pass.inputs.copy_from_slice(&at.inputs);
            if column < n {
                pass.x[column] += by
            } else {
                pass.inputs[column - n] += by
            }
            pass.evaluate(m, None).expect("on the rails");
            pass.dx.iter().chain(&pass.row).copied().collect()
        };
        let exact = |row: usize, column: usize| match (row < n, column < n) {
            (true, true) => linear.a[row * n + column],
            (true, false) => linear.b[row * inputs + column - n],
            (false, true) => linear.c[(row - n) * n + column],
            (false, false) => linear.d[(row - n) * inputs + column - n],
        };
        let units: Vec<f64> = linear.states.iter().chain(&linear.inputs).map(|(_, unit)| scale(unit)).collect();
        let typical: Vec<f64> = (0..n + outputs)
            .map(|row| (0..n + inputs).map(|column| (exact(row, column) * units[column]).abs()).fold(1e-12, f64::max))
            .collect();
        let mut worst: f64 = 0.0;
        for (column, unit) in units.iter().enumerate() {
            let h = 2e-4 * unit;
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| at_place(column, k * h));
            for row in 0..n + outputs {
                let difference = ((a[row] - d[row]) + 8.0 * (c[row] - b[row])) / (12.0 * h);
                let error = (difference - exact(row, column)).abs() * unit / typical[row];
                worst = worst.max(error);
                assert!(error < 1e-6, "{law}: row {row}, column {column}: {difference} {}", exact(row, column));
            }
        }
        println!("{law}: {worst:.1e}");
    }
}
