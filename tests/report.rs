//! Reports of made-up runs: complete, self-contained, and safe for any text.
//!
//! `GRAINFLOW_REPORT_SAMPLES=DIR cargo test --test report` leaves the pages in DIR, to be looked at.

mod report_samples;

use grainflow::record::contents::{Frame, RunLog};
use grainflow::report::{grains_png, render};
use grainflow::scenario::kinds::Kinds;
use grainflow::simulation::figures::KEYS;
use report_samples::{Sample, all, bed, cooling, heap, pipe, shear};
use serde_json::Map;

fn page(sample: &Sample) -> String {
    render(&sample.log, &sample.summary)
}

#[test]
fn every_sample_has_a_page_that_needs_no_network() {
    for sample in all() {
        let page = page(&sample);
        if let Some(folder) = std::env::var_os("GRAINFLOW_REPORT_SAMPLES") {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(std::path::Path::new(&folder).join(format!("{}.html", sample.name)), &page)
                .unwrap();
        }
        assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"), "{}", sample.name);
        for foreign in ["http://", "https://", "<link rel=\"stylesheet", "@import", "src=\"//"] {
            assert!(!page.contains(foreign), "{}: {foreign}", sample.name);
        }
        // Numbers of plots; embedded data may spell anything.
        assert!(
            page.split("<svg").skip(1).all(|plot| !plot.contains("\"NaN") && !plot.contains(" NaN")),
            "{}",
            sample.name
        );
        assert!(page.len() < 12_000_000, "{}: {} bytes", sample.name, page.len());
    }
}

#[test]
fn text_from_outside_cannot_become_markup() {
    let mut sample = cooling();
    let attack = "</script><script>alert(1)</script>";
    sample.log.metadata.insert(attack.to_owned(), attack.to_owned());
    sample.log.scenario.push_str(&format!("[units]\ntime = '{attack}'\nlength = '{attack}'\n"));
    sample.log.columns[5].name = attack.to_owned();
    sample.log.profiles[0].name = attack.to_owned();
    sample.log.walls.as_mut().unwrap().sides[0][0] = attack.to_owned();
    sample.summary.insert(attack.to_owned(), attack.into());
    sample.summary.insert("engine".to_owned(), attack.into());
    let page = page(&sample);
    assert!(!page.contains("<script>alert"));
    // The page's own: parameters, data, player.
    assert_eq!(page.matches("<script").count(), 3);
}

#[test]
fn an_empty_log_has_a_page() {
    let page = render(&RunLog::default(), &Map::new());
    assert!(page.contains("<h1>run</h1>") && !page.contains("<canvas") && !page.contains("<svg"));
}

#[test]
fn a_damaged_log_has_a_page() {
    for mut sample in all() {
        for frame in &mut sample.log.frames {
            frame.velocities.truncate(3);
            frame.ids.clear();
            if let Some(position) = frame.positions.first_mut() {
                *position = [f32::NAN, f32::INFINITY, 0.0];
            }
        }
        sample.log.series.iter_mut().for_each(|row| row.truncate(2));
        for profile in &mut sample.log.profiles {
            profile.values[1].truncate(2);
            profile.values[0].push(f64::NAN);
        }
        sample.log.walls = None;
        assert!(page(&sample).contains("<h1>"), "{}", sample.name);
    }
}

#[test]
fn each_scenario_shows_what_it_is_about() {
    let has = |sample: Sample, texts: &[&str]| {
        let page = page(&sample);
        texts.iter().for_each(|text| assert!(page.contains(text), "{}: {text}", sample.name));
    };
    has(heap(), &["Growth of the heap", "over √t", "logarithmic tail", "Centre of mass height"]);
    has(cooling(), &["Haff’s law", "homogeneous cooling", "Impact parameter", "Cluster share", "eq. 4.44"]);
    has(shear(), &["linear law", "Wall shear stress", "mean 0.001310", "2.1 ± 25 %", "Wall normal stress"]);
    has(pipe(), &["Density in space and time", "slope −1.610 ± 0.040", "Density contrast", "&gt; 2.5"]);
    has(bed(), &["interrupted before its end", "3000 spheres", "Drag"]);
}

#[test]
fn references_say_what_they_are() {
    assert!(page(&shear()).contains("References are closed forms"));
}

/// The text of the first element of the class.
fn cards(page: &str) -> &str {
    let from = page.find("<dl class=\"figures\">").map_or(0, |start| start);
    let length = page[from..].find("</header>").unwrap_or(page.len() - from);
    &page[from..from + length]
}

#[test]
fn figures_come_first_and_counters_are_folded() {
    let mut sample = heap();
    let counters = [("candidates", 32_454_860), ("cell_capacity", 4), ("removed", 0)];
    counters
        .iter()
        .for_each(|(name, value)| drop(sample.summary.insert((*name).to_owned(), (*value).into())));
    sample.summary.insert("centre_of_mass_mean_height".to_owned(), 12.1067.into());
    sample.summary.insert("centre_of_mass_mean_height_standard_error".to_owned(), 0.41.into());
    let page = page(&sample);
    let cards = cards(&page);
    let place = |text: &str| cards.find(text).unwrap_or_else(|| panic!("{text}"));
    assert!(
        place("heap slope") < place("centre of mass height")
            && place("mean height") < place("computing time")
    );
    assert!(cards.contains("12.11 ± 0.41 <small>d</small>"));
    assert!(!cards.contains("candidates") && !cards.contains("removed"));
    assert!(page.contains("<td>candidates</td><td>32\u{202f}454\u{202f}860</td>"));
}

#[test]
fn means_of_what_is_not_steady_are_not_shown() {
    let mut sample = cooling();
    let pressure = [("pressure", 0.0103), ("pressure_standard_error", 0.001)];
    pressure
        .iter()
        .for_each(|(name, value)| drop(sample.summary.insert((*name).to_owned(), (*value).into())));
    assert!(!cards(&page(&sample)).contains("<dt>pressure"));
    sample.log.series.iter_mut().for_each(|row| row[2] = 1.0);
    assert!(cards(&page(&sample)).contains("<dt>pressure"));
}

#[test]
fn a_run_too_short_for_its_figures_says_so() {
    let mut sample = shear();
    assert!(!cards(&page(&sample)).contains("class=\"doubt\""));
    sample.summary.insert("velocity_profile_r_squared".to_owned(), 0.02.into());
    assert!(cards(&page(&sample)).contains("the profile is no straight line: R² = 0.02"));
    sample.summary.insert("velocity_profile_r_squared".to_owned(), 0.99.into());
    sample.summary.insert("collisions_per_particle".to_owned(), 2.0.into());
    assert!(cards(&page(&sample)).contains("too short to be steady"));
    // A tested trend knows better.
    for name in ["wall_shear_stress", "velocity_profile_slope"] {
        sample.summary.insert(format!("{name}_steady"), true.into());
    }
    assert!(!cards(&page(&sample)).contains("too short to be steady"));
}

#[test]
fn a_figure_that_is_not_steady_is_no_number_and_gets_no_verdict() {
    let mut sample = shear();
    assert_eq!(
        page(&sample).matches("<b>agrees").count(),
        2,
        "the sample agrees with both of its references"
    );
    sample.summary.insert("wall_shear_stress_steady".to_owned(), false.into());
    sample.summary.insert("wall_shear_stress_trend".to_owned(), "falling".into());
    let page = page(&sample);
    let cards = cards(&page);
    assert!(cards.contains("<dt>wall shear stress</dt><dd>not steady</dd>"), "{cards}");
    assert!(cards.contains("falling, mean 0.00131"), "{cards}");
    assert!(!cards.contains("0.00131 ±") && !page.contains("mean 0.001310"), "no error beside a drift");
    assert!(page.contains("Not steady: falling"));
    assert_eq!(page.matches("<b>agrees").count(), 1);
    assert!(page.contains("<b>no verdict: "));
}

#[test]
fn no_run_is_held_against_this_program() {
    for sample in all() {
        let page = page(&sample).to_lowercase();
        assert!(!page.contains("this program made") && !page.contains("regression"), "{}", sample.name);
    }
    assert!(!page(&heap()).contains("<b>agrees"));
}

#[test]
fn known_faults_of_an_engine_stand_beside_the_figures_they_concern() {
    let steep = page(&heap());
    assert!(steep.contains("Known of this engine here: hsmc makes heaps too steep"));
    assert!(cards(&steep).contains("<dd>known fault: hsmc makes heaps too steep"));
    let stress = page(&shear());
    let fault = "<dd>known fault: hsmc with cells of";
    let card = |title: &str| {
        let cards = cards(&stress);
        let start = cards.find(&format!("<dt>{title}</dt>")).unwrap_or_else(|| panic!("{title}: {cards}"));
        cards[start..].split_once("</div>").map_or("", |(card, _)| card)
    };
    assert!(card("wall shear stress").contains(fault));
    assert!(!card("velocity profile slope").contains(fault));
}

#[test]
fn the_equation_of_state_knows_the_transfer() {
    let expected = |key: &str| {
        let mut sample = cooling();
        sample.log.scenario =
            sample.log.scenario.replace("kind = \"hsmc\"\n", &format!("kind = \"hsmc\"\n{key}"));
        page(&sample)
    };
    // 1 + 2r ν g and 1 + (1 + r) ν g at r = 0.8, ν = 0.25.
    assert!(expected("transfer = \"momentum-change\"\n").contains("1.633 ± 3 %"), "2r");
    assert!(expected("").contains("1.633 ± 3 %"), "2r");
    assert!(expected("transfer = \"corrected\"\n").contains("1.713 ± 3 %"), "1 + r");
}

#[test]
fn waves_are_for_pipes_and_floors_for_heaps() {
    let waves = "Waves are bright bands";
    assert!(page(&pipe()).contains(waves) && page(&pipe()).contains("Gravity points to the left"));
    for sample in [heap(), shear(), cooling()] {
        assert!(!page(&sample).contains(waves), "{}", sample.name);
    }
    assert!(
        page(&heap()).contains("dots hide behind each other")
            && page(&heap()).contains("Gravity points down")
    );
}

#[test]
fn theory_is_shown_where_it_holds() {
    // With walls a gas does not cool as Haff says.
    let walls = "x = { lower = { wall = \"smooth\" }, upper = { wall = \"smooth\" } }\n";
    assert!(page(&cooling()).contains("Haff’s law"));
    assert!(!with("x = \"periodic\"\n", walls).contains("Haff’s law"));
}

#[test]
fn pictures_show_the_grains() {
    let sample = heap();
    let frame = sample.log.frames.last().unwrap();
    let alike = Kinds::default();
    let full = grains_png(frame, sample.log.walls.as_ref(), &alike, 800);
    let empty = grains_png(&Frame::default(), sample.log.walls.as_ref(), &alike, 800);
    assert!(full.starts_with(b"\x89PNG") && full.len() > 4 * empty.len());
}

/// The page of [`cooling`] whose scenario has `text` in place of `part`.
fn with(part: &str, text: &str) -> String {
    let mut sample = cooling();
    assert!(sample.log.scenario.contains(part), "{part}");
    sample.log.scenario = sample.log.scenario.replace(part, text);
    page(&sample)
}

#[test]
fn theory_of_smooth_equal_grains_is_for_them_alone() {
    let grains = "diameter = 1.0\nmass = 1.0\nrestitution = 0.8\nvolume_fraction = 0.25\n";
    let law = |page: &str| page.contains("nothing is fitted") || page.contains("eq. 4.44");
    assert!(law(&with(grains, grains)));
    let kinds = "[[particles.species]]\ndiameter = 1.0\nmass = 1.0\nshare = 0.5\n\
                 [[particles.species]]\ndiameter = 2.0\nmass = 4.0\nshare = 0.5\n";
    let event_driven = |scenario: &str| {
        let mut sample = cooling();
        sample.log.scenario = scenario.replace("\"hsmc\"", "\"event-driven\"");
        sample.summary.insert("engine".to_owned(), "event-driven".into());
        page(&sample)
    };
    let text = cooling().log.scenario;
    let mixture =
        event_driven(&text.replace(grains, &format!("restitution = 0.8\nvolume_fraction = 0.25\n{kinds}")));
    assert!(!law(&mixture) && mixture.contains("does not know grains of several kinds"));
    assert!(mixture.contains("of 2 kinds of restitution 0.8") && mixture.contains("all are drawn alike"));
    let rough = event_driven(&text.replace(grains, &format!("{grains}tangential_restitution = 0.3\n")));
    assert!(!law(&rough) && rough.contains("does not know rough grains"));
    let glancing = with("kind = \"hsmc\"\n", "kind = \"hsmc\"\nimpact_parameter = { c = 0.5 }\n");
    assert!(!law(&glancing) && glancing.contains("engine.impact_parameter other than molecular chaos"));
}

#[test]
fn a_scenario_of_another_version_is_said_to_be_unread() {
    let newer = with("kind = \"hsmc\"\n", "kind = \"hsmc\"\nspooky_action = 1\n");
    assert!(newer.contains("cannot be read by this version") && newer.contains("spooky_action"));
    assert!(!newer.contains("nothing is fitted") && newer.contains("<canvas"));
}

#[test]
fn a_straight_profile_is_expected_where_walls_alone_drive() {
    let expected = "Linear profile between moving walls";
    let mut sample = shear();
    assert!(page(&sample).contains(expected));
    sample.log.scenario =
        sample.log.scenario.replacen("dimension = 2\n", "dimension = 2\ngravity = [0.1, 0.0]\n", 1);
    let pulled = page(&sample);
    assert!(!pulled.contains(expected) && !pulled.contains("linear law") && !pulled.contains("2.1 ± 25 %"));
}

#[test]
fn what_every_run_has_is_no_figure_of_the_physics() {
    let mut sample = cooling();
    for (key, _) in KEYS {
        sample.summary.entry(key).or_insert(7.5.into());
    }
    let page = page(&sample);
    let own = &cards(&page)[..cards(&page).find("class=\"figures facts\"").unwrap()];
    for (key, _) in KEYS {
        assert!(!own.contains(&format!("<dt>{}</dt>", key.replace('_', " "))), "{key}");
    }
    assert!(
        cards(&page).contains("<dt>resumed at</dt>") && page.contains("<td>cured share</td><td>7.5</td>")
    );
}
