use proptest::prelude::*;
use proptest::sample::{select, subsequence};

use slipfront::observe::Field;
use slipfront::surface::Orientation;
use slipfront::{Edges, Face, StopReason, next_side};
use slipfront_case::case_file::{
    AfterBreak, Ageing, AgeingLaw, Along, Arrangement, Array, Attached, AttachedEdge, AutoOr,
    AutoOrStiffness, Bearing, Body, CaseFile, Cavity, CavitySize, Center, ContactModel, Count, Damping,
    Drawing, Drive, DriveSpeed, DriveStiffness, EdgeSprings, Friction, Grade, Groove, GrooveSize, HeightMap,
    Initial, KineticFriction, Law, Level, Load, Loading, Mask, Missing, Motion, Near, Outline, Output,
    Pattern, Pitch, Polygon, Profile, Redistribute, RunTime, Shape, Slider, SlipWeakeningLength, Snapshots,
    Source, SpeedSegment, Texture, Time, TimeStep, Velocity, VelocityLaw,
};
use slipfront_case::quantity::{Kind, Length, Quantity};
use slipfront_case::table::{DecimalSign, FieldSeparator};
use test_case::test_case;

/// Quantities of many sizes, some in a user's notation and some printed from their value.
fn quantity<K: Kind + 'static>(
    low: i32,
    high: i32,
    units: &'static [&'static str],
) -> BoxedStrategy<Quantity<K>> {
    let written =
        (1..=999_u32, select(units)).prop_map(|(digits, unit)| format!("{digits} {unit}").parse().unwrap());
    let printed =
        (1.0..10.0_f64, low..high).prop_map(|(digits, power)| Quantity::from_si(digits * 10_f64.powi(power)));
    prop_oneof![written, printed].boxed()
}

fn length() -> BoxedStrategy<Length> {
    quantity(-12, 2, &["um", "\u{b5}m", "nm", "mm"])
}

fn auto_or(number: impl Strategy<Value = f64> + 'static) -> BoxedStrategy<AutoOr> {
    prop_oneof![Just(AutoOr::Auto), number.prop_map(AutoOr::Number)].boxed()
}

fn file(endings: &'static [&'static str]) -> BoxedStrategy<String> {
    ("[a-z][a-z\"' \u{e9}\\\\/]{0,8}[a-z]", select(endings))
        .prop_map(|(name, ending)| format!("{name}.{ending}"))
        .boxed()
}

fn slider() -> impl Strategy<Value = Slider> {
    let damping = prop_oneof![
        (0.0..1e3).prop_map(Damping::OmegaStar),
        quantity(0, 23, &["1/s", "MHz"]).prop_map(Damping::Rate)
    ];
    let edge = || select(vec![Edges::Free, Edges::Periodic]);
    let mask = file(&["png", "npy"]).prop_map(|file| (Outline::Mask, Some(file)));
    let outline = prop_oneof![
        Just((Outline::Rectangle, None)),
        Just((Outline::Disc, None)),
        mask
    ];
    let ends = || (select(vec![Along::X, Along::Y]), 1e-6..1e6, 1e-6..1e6);
    let grade = || ends().prop_map(|(along, from, to)| (None, Some(Grade { along, from, to })));
    let field = || prop::option::of(file(&["npy", "csv"])).prop_map(|field| (field, None));
    let property = || prop_oneof![grade(), field()];
    (
        (3..60_000_u32, 3..60_000_u32),
        (length(), prop::option::of(length())),
        quantity(-3, 14, &["GPa", "bar", "N/mm^2"]),
        quantity(-6, 8, &["g/cm^3", "kg m^-3"]),
        damping,
        [edge(), edge()],
        outline,
        [property(), property()],
        0.0..1e3,
    )
        .prop_map(
            |(
                (nx, ny),
                (block_size, thickness),
                young_modulus,
                density,
                damping,
                edges,
                (outline, outline_file),
                [(stiffness_field, stiffness_grade), (density_field, density_grade)],
                viscosity_time_star,
            )| Slider {
                blocks: if outline == Outline::Disc {
                    [nx; 2]
                } else {
                    [nx, ny]
                },
                block_size,
                thickness,
                rigid: false,
                body: Body::Sheet,
                height: None,
                poisson: None,
                face: Face::Pressure,
                young_modulus,
                density,
                damping,
                edges: if outline == Outline::Rectangle {
                    edges
                } else {
                    [Edges::Free; 2]
                },
                // Halved springs need a rectangle with more than one row and column.
                edge_springs: if outline == Outline::Rectangle && nx.min(ny) > 1 && nx % 2 == 0 {
                    EdgeSprings::Halved
                } else {
                    EdgeSprings::Whole
                },
                outline,
                outline_file,
                viscosity_time_star,
                stiffness_field,
                stiffness_grade,
                density_field,
                density_grade,
            },
        )
}

/// A bulk body on sides that its transform has.
fn bulk() -> impl Strategy<Value = Slider> {
    // At least as high as the largest block.
    let height = prop::option::of(quantity(2, 6, &["km"]));
    let face = prop::sample::select(vec![Face::Pressure, Face::Flat]);
    (slider(), height, prop::option::of(0.0..0.5), face).prop_map(|(slider, height, poisson, face)| Slider {
        body: Body::Bulk,
        blocks: slider.blocks.map(|n| next_side(n as usize) as u32),
        edges: [Edges::Periodic; 2],
        edge_springs: EdgeSprings::Whole,
        thickness: None,
        height,
        poisson,
        face,
        outline: Outline::Rectangle,
        outline_file: None,
        viscosity_time_star: 0.0,
        stiffness_field: None,
        stiffness_grade: None,
        density_field: None,
        density_grade: None,
        ..slider
    })
}

fn load() -> impl Strategy<Value = Load> {
    let profile = (select(vec![Along::X, Along::Y]), -0.99..0.99);
    let profile = profile.prop_map(|(along, relative_slope)| {
        (
            Some(Profile {
                along,
                relative_slope,
            }),
            None,
        )
    });
    let field = prop::option::of(file(&["npy", "csv"])).prop_map(|field| (None, field));
    let local = prop_oneof![profile, field];
    let pressure = quantity(-9, 14, &["kPa", "Pa"]);
    let near = length().prop_map(|within| Redistribute::Near(Near { within }));
    let redistribute = prop_oneof![2 => any::<bool>().prop_map(Redistribute::All), 1 => near];
    let field = || prop::option::of(file(&["npy", "csv"]));
    let shear = prop_oneof![
        Just((None, None, None)),
        (quantity(-9, 14, &["kPa", "Pa"]), field()).prop_map(|(shear, field)| (Some(shear), None, field)),
        (-1e3..1e3, field()).prop_map(|(star, field)| (None, Some(star), field)),
    ];
    (pressure, redistribute, local, shear).prop_map(
        |(pressure, redistribute, (profile, pressure_field), (shear, shear_star, shear_field))| Load {
            pressure,
            redistribute,
            profile,
            pressure_field,
            shear,
            shear_star,
            shear_field,
            foundation: None,
            foundation_star: None,
        },
    )
}

fn drive() -> impl Strategy<Value = Drive> {
    // Times are cumulative sums, so that they increase, and the first speed is positive.
    let program =
        prop::collection::vec((-10.0..10.0, 0.01..100.0), 1..6).prop_map(|parts: Vec<(f64, f64)>| {
            let mut until = 0.0;
            let count = parts.len();
            let segments = parts.into_iter().enumerate().map(|(number, (v_star, lasts))| {
                until += lasts;
                let until_star = (number + 1 < count).then_some(until);
                let v_star: f64 = if number == 0 {
                    v_star.abs().max(1e-6)
                } else {
                    v_star
                };
                SpeedSegment { v_star, until_star }
            });
            DriveSpeed::Program(segments.collect())
        });
    let speed = prop_oneof![
        (1e-6..1.35).prop_map(DriveSpeed::VStar),
        quantity(-18, 5, &["mm/s", "m s^-1"]).prop_map(DriveSpeed::Speed),
        program
    ];
    // Edges and rotation exclude periodic sliders and directions; files in `good` test them.
    let attached = prop_oneof![
        Just(Attached::At(AttachedEdge::All)),
        file(&["npy", "png"]).prop_map(Attached::File)
    ];
    let newtons = || quantity(-20, 20, &["N/m", "kN/mm"]);
    let stiffness = prop_oneof![
        Just(DriveStiffness::Each(AutoOrStiffness::Auto)),
        newtons().prop_map(|each| DriveStiffness::Each(AutoOrStiffness::Stiffness(each))),
        newtons().prop_map(DriveStiffness::Total),
        quantity(-20, 20, &["N/m^3", "kN/mm^3"]).prop_map(DriveStiffness::PerArea),
        (1e-9..1e6).prop_map(DriveStiffness::EachStar),
        (1e-9..1e6).prop_map(DriveStiffness::TotalStar)
    ];
    (speed, -360.0..360.0, attached, stiffness).prop_map(|(speed, direction, attached, stiffness)| Drive {
        speed,
        direction,
        motion: Motion::Translation,
        loading: Loading::Constant,
        attached,
        stiffness,
    })
}

fn friction() -> impl Strategy<Value = Friction> {
    let kinetic = prop_oneof![
        (0.0..10.0).prop_map(KineticFriction::RStar),
        (0.0..1.0).prop_map(KineticFriction::MuKinetic)
    ];
    let field = || prop::option::of(file(&["npy", "csv"]));
    let adhesion = || quantity(-9, 14, &["kPa", "Pa"]);
    let base = CaseFile::default().friction;
    let plain = (
        0.1..100.0,
        kinetic,
        [0.0..1.0, 0.0..1.0],
        0..=i64::MAX as u64,
        [field(), field()],
        [adhesion(), adhesion()],
        prop::option::of(length()),
    )
        .prop_map(
            move |(
                mu_static,
                kinetic,
                [sigma_static_star, sigma_kinetic_star],
                seed,
                [mu_static_field, mu_kinetic_field],
                [adhesion, adhesion_kinetic],
                correlation_length,
            )| {
                Friction {
                    mu_static,
                    kinetic,
                    sigma_static_star,
                    sigma_kinetic_star,
                    seed,
                    mu_static_field,
                    mu_kinetic_field,
                    adhesion,
                    adhesion_kinetic,
                    correlation_length,
                    ..base.clone()
                }
            },
        );
    prop_oneof![
        (plain.clone(), of_coefficients()).prop_map(|(plain, law)| Friction {
            law: law.law,
            velocity: law.velocity,
            ageing: law.ageing,
            slip_weakening: law.slip_weakening,
            healing_time_star: law.healing_time_star,
            correlation_length: drawn(&plain, plain.mu_kinetic_field.is_none()),
            ..plain
        }),
        (plain, springs()).prop_map(|(plain, law)| {
            let slides = law.after_break == AfterBreak::Slide;
            let draws_kinetic = slides && plain.mu_kinetic_field.is_none();
            let of_kinetic = if slides { plain.clone() } else { law.clone() };
            Friction {
                kinetic: of_kinetic.kinetic,
                sigma_kinetic_star: of_kinetic.sigma_kinetic_star,
                mu_kinetic_field: of_kinetic.mu_kinetic_field,
                adhesion_kinetic: of_kinetic.adhesion_kinetic,
                contact: law.contact,
                contact_stiffness_star: law.contact_stiffness_star,
                contact_stiffness_per_area: law.contact_stiffness_per_area,
                after_break: law.after_break,
                redraw: law.redraw,
                correlation_length: drawn(&plain, draws_kinetic).filter(|_| !law.redraw),
                ..plain
            }
        }),
        rate_and_state(),
    ]
}

/// A correlation length, unless all coefficients are given.
fn drawn(plain: &Friction, draws_kinetic: bool) -> Option<Length> {
    let is_drawn = draws_kinetic || plain.mu_static_field.is_none();
    plain.correlation_length.clone().filter(|_| is_drawn)
}

/// Laws of static and kinetic coefficients.
fn of_coefficients() -> impl Strategy<Value = Friction> {
    let base = CaseFile::default().friction;
    let velocity = (1e-6..10.0, 0.0..1.0).prop_map(|(v_c_star, ratio)| Velocity {
        law: VelocityLaw::Weakening,
        v_c_star,
        ratio,
    });
    let ageing = (0.0..10.0, 1e-6..1e9).prop_map(|(beta, time_star)| Ageing {
        law: AgeingLaw::Logarithmic,
        beta,
        time_star,
    });
    let of_slip = prop_oneof![
        length().prop_map(|length| (Some(length), None)),
        (1e-6..1e9).prop_map(|star| (None, Some(star)))
    ];
    let of_slip = of_slip.prop_map(|(length, length_star)| SlipWeakeningLength { length, length_star });
    let varying = (prop::option::of(velocity), prop::option::of(ageing));
    let varying = varying.prop_map(|(velocity, ageing)| (Law::Projection, (velocity, ageing, None, None)));
    let slips = (of_slip, prop::option::of(1e-6..1e9));
    let slips = slips.prop_map(|(law, healing)| (Law::Projection, (None, None, Some(law), healing)));
    let other = select(vec![Law::Reversal, Law::Literal]).prop_map(|law| (law, (None, None, None, None)));
    prop_oneof![varying, slips, other].prop_map(
        move |(law, (velocity, ageing, slip_weakening, healing_time_star))| Friction {
            law,
            velocity,
            ageing,
            slip_weakening,
            healing_time_star,
            ..base.clone()
        },
    )
}

fn springs() -> impl Strategy<Value = Friction> {
    let base = CaseFile::default().friction;
    let stiffness = prop_oneof![
        (1e-6..1e3).prop_map(|star| (Some(star), None)),
        quantity(-20, 20, &["N/m^3"]).prop_map(|per_area| (None, Some(per_area)))
    ];
    let after_break = prop_oneof![
        any::<bool>().prop_map(|redraw| (AfterBreak::FormAgain, redraw)),
        Just((AfterBreak::Slide, false))
    ];
    (stiffness, after_break).prop_map(move |((star, per_area), (after_break, redraw))| Friction {
        contact: ContactModel::Springs,
        contact_stiffness_star: star,
        contact_stiffness_per_area: per_area,
        after_break,
        redraw,
        ..base.clone()
    })
}

fn rate_and_state() -> impl Strategy<Value = Friction> {
    let base = CaseFile::default().friction;
    let optional = |most: f64| prop::option::of(1e-6..most);
    (
        (1e-5..10.0, 0.0..10.0, 1e-6..1e9, 1e-6..10.0),
        [optional(100.0), optional(1e9), optional(10.0)],
    )
        .prop_map(
            move |((a, b, d_c, v_0), [mu_0, theta_0_star, slip_speed_star])| Friction {
                law: Law::RateAndState,
                a: Some(a),
                b: Some(b),
                d_c_star: Some(d_c),
                v_0_star: Some(v_0),
                mu_0,
                theta_0_star,
                slip_speed_star,
                ..base.clone()
            },
        )
}

fn cavity() -> impl Strategy<Value = Shape> {
    let size = prop_oneof![
        (0.001..99.9).prop_map(CavitySize::Coverage),
        length().prop_map(CavitySize::Lambda)
    ];
    let center = prop_oneof![Just(Center::Middle), [length(), length()].prop_map(Center::At)];
    (
        1..=64_u32,
        -0.99..0.99,
        size,
        any::<bool>(),
        center,
        -360.0..360.0,
    )
        .prop_map(|(s, share, size, across, center, rotate)| {
            Shape::Cavity(Cavity {
                s,
                w: share / f64::from(s),
                size,
                across,
                center,
                rotate,
            })
        })
}

fn height_map() -> impl Strategy<Value = Shape> {
    let bearing = prop_oneof![
        (0.001..99.9).prop_map(|percent| (Bearing::Percent(percent), None)),
        (length(), prop::option::of(length()))
            .prop_map(|(depth, reference)| (Bearing::Depth(depth), reference)),
    ];
    let pixel_size = prop_oneof![
        length().prop_map(Pitch::Equal),
        [length(), length()].prop_map(Pitch::Each)
    ];
    let units = (prop::option::of(length()), prop::option::of(pixel_size));
    let file = file(&["npy", "csv", "gsf", "x3p", "png", "tif", "tiff"]);
    let missing = prop_oneof![Just(Missing::Nan), (-1e9..1e9).prop_map(Missing::Value)];
    let decimals = select(vec![DecimalSign::Point, DecimalSign::Comma]);
    let separators = select(vec![FieldSeparator::Tab, FieldSeparator::Semicolon]);
    let preparation = (
        prop::option::of(Just(Level::Plane)),
        prop::option::of(missing),
        prop::option::of(decimals),
        prop::option::of(separators),
    );
    (file, bearing, units, preparation).prop_map(
        |(file, (bearing, reference), (height_unit, pixel_size), (level, missing, decimal, separator))| {
            Shape::HeightMap(HeightMap {
                file,
                bearing,
                reference,
                height_unit,
                pixel_size,
                level,
                decimal,
                separator,
                missing,
            })
        },
    )
}

fn texture() -> impl Strategy<Value = Texture> {
    let size = prop_oneof![
        (0.001..99.9).prop_map(GrooveSize::Coverage),
        length().prop_map(GrooveSize::Width)
    ];
    let groove = (
        select(vec![Orientation::Across, Orientation::Along]),
        size,
        length(),
    )
        .prop_map(|(orientation, size, offset)| {
            Shape::Groove(Groove {
                orientation,
                size,
                offset,
            })
        });
    let polygon = prop::collection::vec([length(), length()], 3..8)
        .prop_map(|points| Shape::Polygon(Polygon { points }));
    let mask = (file(&["png", "npy"]), 0.01..0.99)
        .prop_map(|(file, threshold)| Shape::Mask(Mask { file, threshold }));
    let drawing = file(&["svg", "dxf"]).prop_map(|file| Shape::Drawing(Drawing { file }));
    let shape = prop_oneof![cavity(), groove, polygon, mask, height_map(), drawing];
    let parts = (shape, array(), prop::option::of(array()), any::<bool>());
    parts.prop_filter_map(
        "repeat needs a count or a pitch",
        |(shape, own, repeat, invert)| {
            let is_array = |array: &Array| array.pitch.is_some() || array.array != Count::Auto;
            let is_valid =
                (own.lattice == Arrangement::Square || is_array(&own)) && repeat.iter().all(is_array);
            let Array {
                pitch,
                array,
                lattice,
            } = own;
            let pattern = Pattern {
                pitch,
                array,
                lattice,
                repeat,
                invert,
            };
            is_valid.then_some(Texture { shape, pattern })
        },
    )
}

fn array() -> impl Strategy<Value = Array> {
    let count = prop_oneof![
        Just(Count::Auto),
        [1..=1000_u32, 1..=1000_u32].prop_map(Count::Of)
    ];
    let equal = (prop::option::of(length().prop_map(Pitch::Equal)), any::<bool>());
    let arranged = prop_oneof![
        equal.prop_map(|(pitch, is_square)| {
            let lattice = if is_square {
                Arrangement::Square
            } else {
                Arrangement::Hexagonal
            };
            (pitch, lattice)
        }),
        [length(), length()].prop_map(|pitch| (Some(Pitch::Each(pitch)), Arrangement::Staggered)),
    ];
    (count, arranged).prop_map(|(array, (pitch, lattice))| Array {
        pitch,
        array,
        lattice,
    })
}

fn time() -> impl Strategy<Value = Time> {
    let duration = prop_oneof![
        auto_or(10.0..1e9).prop_map(RunTime::Star),
        quantity(-24, 12, &["ns", "s"]).prop_map(RunTime::Duration)
    ];
    let step = prop_oneof![
        Just(TimeStep::Auto),
        Just(TimeStep::Paper),
        (1e-9..0.9057).prop_map(TimeStep::Number)
    ];
    (
        duration,
        step,
        select(vec![StopReason::End, StopReason::Onset]),
        auto_or(0.0..5.0),
    )
        .prop_map(|(duration, step, stop, kinetic_from_star)| Time {
            duration,
            step,
            stop,
            kinetic_from_star,
        })
}

fn output() -> impl Strategy<Value = Output> {
    let snapshots = prop_oneof![
        Just(Snapshots::Auto),
        prop::collection::btree_set(0..1_000_000_u32, 0..6)
            .prop_map(|times| Snapshots::At(times.into_iter().map(|time| f64::from(time) / 7.0).collect())),
        (1e-3..1e6).prop_map(Snapshots::Every)
    ];
    let fields = subsequence(CaseFile::default().output.fields, 0..=5).prop_shuffle();
    (
        snapshots,
        fields,
        1..=100_000_u32,
        auto_or(1e-6..1e6),
        any::<[bool; 3]>(),
    )
        .prop_map(
            |(snapshots, fields, stride, series, [movie, events, final_state]): (_, Vec<Field>, _, _, _)| {
                Output {
                    snapshots,
                    fields,
                    stride,
                    series,
                    movie,
                    events,
                    final_state,
                }
            },
        )
}

fn initial() -> impl Strategy<Value = Initial> {
    let name = || file(&["npy", "csv"]);
    let field = || prop::option::of(name());
    let displacement = (name(), field(), prop::option::of(length()));
    let displacement = displacement.prop_map(|(x, y, unit)| (Some(x), y, unit));
    let velocity = (field(), name(), prop::option::of(quantity(-18, 5, &["mm/s"])));
    let velocity = velocity.prop_map(|(x, y, unit)| (x, Some(y), unit));
    (
        prop_oneof![Just((None, None, None)), displacement],
        prop_oneof![Just((None, None, None)), velocity],
    )
        .prop_map(
            |(
                (displacement_x, displacement_y, displacement_unit),
                (velocity_x, velocity_y, velocity_unit),
            )| {
                Initial {
                    state_file: None,
                    displacement_x,
                    displacement_y,
                    displacement_unit,
                    velocity_x,
                    velocity_y,
                    velocity_unit,
                }
            },
        )
}

fn case_file() -> impl Strategy<Value = CaseFile> {
    let textures = prop::collection::vec(texture(), 0..4);
    let loading = select(vec![Loading::Constant, Loading::Held]);
    let drive = (drive(), loading);
    let body = prop_oneof![3 => slider().boxed(), 1 => bulk().boxed()];
    (
        body,
        load(),
        drive,
        friction(),
        textures,
        initial(),
        time(),
        output(),
    )
        .prop_map(
            |(slider, mut load, (mut drive, loading), friction, texture, mut initial, time, mut output)| {
                let source = Source::default();
                // Blocks under other laws do not come to rest, or strengthen with time.
                let stops = friction.law == Law::Projection && friction.contact == ContactModel::Rigid;
                if stops && friction.ageing.is_none() && friction.healing_time_star.is_none() {
                    drive.loading = loading;
                }
                // A bulk body is driven over its whole upper face.
                if slider.body == Body::Bulk {
                    drive.stiffness = DriveStiffness::Each(AutoOrStiffness::Auto);
                    drive.attached = Attached::At(AttachedEdge::All);
                    drive.motion = Motion::Translation;
                }
                // The shear load and the initial state are not derived for these.
                if slider.body == Body::Bulk {
                    (load.shear, load.shear_star, load.shear_field) = (None, None, None);
                }
                if slider.body == Body::Bulk || friction.contact == ContactModel::Springs {
                    initial = Initial::default();
                    output.final_state = false;
                }
                // A spring that re-forms breaks in an instant.
                output.events &=
                    friction.contact == ContactModel::Rigid || friction.after_break == AfterBreak::Slide;
                CaseFile {
                    slider,
                    load,
                    drive,
                    friction,
                    texture,
                    initial,
                    time,
                    output,
                    source,
                }
            },
        )
}

/// Cases that were once printed wrongly: a field of coefficients without a ratio, and grades with contact
/// springs.
#[test_case("[friction]\nmu_kinetic_field = 'a.npy'\nmu_static_field = 'b.npy'"; "fields in place of a ratio")]
#[test_case(
    "[slider]\nstiffness_grade = { along = 'x', from = 1e-6, to = 1e-6 }\n\
     density_grade = { along = 'x', from = 1e-6, to = 1e-6 }\n\
     [friction]\ncontact = 'springs'\ncontact_stiffness_star = 1e-6";
    "grades with contact springs"
)]
fn a_case_that_was_printed_wrongly_is_read_again(text: &str) {
    let case = CaseFile::parse(text, "printed", &[]).unwrap();
    let printed = case.to_toml().unwrap();
    let read = CaseFile::parse(&printed, "printed", &[]).unwrap();
    assert_eq!(read.to_toml().unwrap(), printed);
    assert_eq!(read, case);
}

proptest! {
    #[test]
    fn printing_and_reading_is_the_identity(case in case_file()) {
        let printed = case.to_toml().unwrap();
        let read = CaseFile::parse(&printed, "printed", &[]);
        prop_assert!(read.is_ok(), "{}\n{printed}", read.unwrap_err());
        let read = read.unwrap();
        prop_assert_eq!(read.to_toml().unwrap(), printed);
        prop_assert_eq!(read, case);
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,40}", table in "\\[[a-z]{0,8}\\]\n[a-z_]{0,9} ?= ?\\PC{0,12}\n", set in "\\PC{0,20}") {
        let _ = CaseFile::parse(&text, "x", &[]);
        let _ = CaseFile::parse(&table, "x", std::slice::from_ref(&set));
        let _ = CaseFile::parse("", "x", &[format!("slider.blocks={set}")]);
    }
}
