use proptest::prelude::*;

use super::*;

/// The value of a form at coordinates of its box, with its error.
fn at(form: Affine, t: [f64; 3]) -> [f64; 2] {
    let value = form.center + (0..3).map(|axis| form.slopes[axis] * t[axis]).sum::<f64>();
    [value - form.error, value + form.error]
}

/// Several formulas in one, so that every kind of operation is met.
fn formulas<N: Number>([x, y, z]: [N; 3]) -> Vec<N> {
    let number = N::constant;
    let length = x.square().add(y.square()).add(z.square()).sqrt();
    let wave = x.mul(number(3.0)).sin().mul(y.cos()).add(z.tanh().exp());
    let corner = x.abs().sub(number(0.7)).max(y.abs().sub(z));
    let blend = x.sub(y).div(number(0.8)).add(number(0.5)).saturate();
    vec![
        length,
        wave,
        corner.min(length),
        x.mix(y, blend)
            .sub(blend.x_times_one_minus_x(number(0.4).mul(number(1.0).sub(blend)), number(0.4))),
        y.atan2(x),
        x.lt(y).select(x.mul(z), y.square().sub(z)),
        x.div(y.add(number(4.0))).add(z.fract()),
        number(-1.0).smoothstep(number(0.5), x),
        length.add(number(0.1)).pow(number(1.5)).add(length.add(number(0.2)).log()),
        x.normalize_lane(length),
        x.clamp_residual(number(-0.2), y),
        z.asin().add(x.atan()).add(y.sinh()).sub(x.cosh()).add(length.inverse_sqrt()),
    ]
}

proptest! {
    #[test]
    fn a_form_contains_the_value_at_every_point_of_its_box(
        center in prop::array::uniform3(-1.0..1.0),
        axes in prop::array::uniform3(prop::array::uniform3(-0.3..0.3)),
        t in prop::array::uniform3(-1.0..1.0),
    ) {
        let form = std::array::from_fn(|axis| Affine::coordinate(center[axis], axes[axis]));
        let coordinate = |axis: usize| {
            center[axis] + (0..3).map(|i| axes[axis][i] * t[i]).sum::<f64>()
        };
        let point = [coordinate(0), coordinate(1), coordinate(2)];
        for (index, (form, value)) in formulas(form).into_iter().zip(formulas(point)).enumerate() {
            if value.is_finite() {
                let [lo, hi] = at(form, t);
                let margin = 1e-12 * (1.0 + value.abs());
                prop_assert!(lo - margin <= value && value <= hi + margin, "{index}: {value} {form:?}");
                let (lo, hi) = (form.range.lo() - margin, form.range.hi() + margin);
                prop_assert!(lo <= value && value <= hi, "{index}: {value} {form:?}");
            }
        }
    }
}

#[test]
fn the_error_shrinks_with_the_square_of_the_box() {
    let width = |size: f64| {
        let p: [f64; 3] = [0.6, 0.5, 0.4];
        let axes = [[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
        let [x, y, z]: [Affine; 3] = std::array::from_fn(|i| Affine::coordinate(p[i], axes[i]));
        let length = x.square().add(y.square()).add(z.square()).sqrt();
        length.error
    };
    let ratio = width(1e-2) / width(1e-3);
    assert!((90.0..110.0).contains(&ratio), "{ratio}");
}
