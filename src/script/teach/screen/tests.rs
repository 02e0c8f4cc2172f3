//! Screens on terminals of several sizes.

use super::{Key, Screen, draw};
use crate::teach::{Trace, sample};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

/// What an 80 × 24 terminal shows after these keys.
fn shown(keys: &[Key]) -> String {
    let mut screen = Screen::new(sample::walk(), false);
    for key in keys {
        assert!(screen.press(*key), "the screen has ended");
    }
    drawn(&screen)
}

fn drawn(screen: &Screen) -> String {
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    terminal.draw(|frame| draw(screen, frame)).unwrap();
    let text = terminal.backend().to_string();
    text.lines()
        .map(|line| line.trim_end_matches('"').trim_start_matches('"').trim_end())
        .fold(String::new(), |all, line| all + line + "\n")
}

fn typed(key: char, answer: &str) -> Vec<Key> {
    let answer = answer.chars().map(Key::Char);
    [Key::Char(key)].into_iter().chain(answer).chain([Key::Enter]).collect()
}

#[test]
fn screens() {
    let after = |keys: &[Key]| keys.to_vec();
    let cases = [
        ("first", after(&[])),
        ("fitness", after(&[Key::Right; 2])),
        ("selection", after(&[Key::Right; 3])),
        ("crossover", after(&[Key::Right; 5])),
        ("mutation", typed('u', "mutation")),
        ("inspect", [after(&[Key::Right; 2]), typed('i', "")].concat()),
        ("help", after(&[Key::Char('?')])),
    ];
    for (name, keys) in cases {
        let text = shown(&keys);
        sample::snapshots().bind(|| insta::assert_snapshot!(format!("screen_{name}"), text));
    }
}

#[test]
fn screens_of_operators() {
    let cases = [("crossover", 0), ("mutation", 3), ("survival", 4)];
    for (name, steps) in cases {
        let trace = Trace::read(&sample::operators()).unwrap();
        let mut screen = Screen::new(crate::teach::TraceCursor::new(trace), false);
        (0..steps).for_each(|_| assert!(screen.press(Key::Right)));
        let text = drawn(&screen);
        sample::snapshots().bind(|| insta::assert_snapshot!(format!("screen_op_{name}"), text));
        // No individual can be followed or inspected there; the keys say so.
        for key in typed('i', "1").into_iter().chain(typed('f', "")).chain([Key::Char('j')]) {
            assert!(screen.press(key));
        }
        drawn(&screen);
    }
}

#[test]
fn keys_move() {
    let first_line = |keys: &[Key]| shown(keys).lines().next().unwrap_or_default().to_owned();
    assert!(first_line(&[Key::Down]).starts_with("Generation 2 of 3, step 1 "));
    assert!(first_line(&[Key::Down, Key::Up]).starts_with("Generation 1 of 3, step 1 "));
    assert!(first_line(&[Key::Right, Key::Left]).starts_with("Generation 1 of 3, step 1 "));
    assert!(first_line(&[Key::Tab]).ends_with("simulation"));
    assert!(first_line(&[Key::End]).ends_with("stop"));
    assert!(first_line(&[Key::End, Key::Home]).starts_with("Generation 1 of 3, step 1 "));
    assert!(first_line(&typed('g', "3")).starts_with("Generation 3 of 3"));
    assert!(first_line(&typed('u', "stop")).starts_with("Generation 3 of 3"));
}

/// The whole trace takes the place of its beginning: the step stays.
#[test]
fn the_step_stays_when_the_run_has_ended() {
    let whole = sample::walk().into_trace();
    let mut begun = whole.clone();
    begun.generations.truncate(2);
    let mut screen = Screen::new(crate::teach::TraceCursor::new(begun), false).while_running();
    assert!(drawn(&screen).contains("the run continues; 2 generations"), "{}", drawn(&screen));
    [Key::Right, Key::Right, Key::Right].into_iter().for_each(|key| assert!(screen.press(key)));
    let place = |screen: &Screen| (screen.walk.number(), screen.walk.step());
    let before = place(&screen);
    screen.ended(Err("the run has failed".to_owned()));
    assert!(place(&screen) == before && drawn(&screen).contains("the run has failed"));
    screen.ended(Ok(whole));
    assert!(place(&screen) == before && drawn(&screen).contains("ended after 3 generations"));
    assert!(drawn(&screen).contains("Generation 1 of 3"), "{}", drawn(&screen));
}

/// On a wide terminal genes are numbers, and every row can be reached on a low one.
#[test]
fn the_population_uses_the_room_there_is() {
    let text = |screen: &Screen, size: (u16, u16)| {
        let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
        terminal.draw(|frame| draw(screen, frame)).unwrap();
        terminal.backend().to_string()
    };
    let mut screen = Screen::new(sample::walk(), false);
    assert!(screen.press(Key::Right));
    let genes = screen.walk.generation().genome(5);
    let last = crate::teach::explain::short(genes[1]);
    let low = text(&screen, (120, 16));
    assert!(low.contains("slope") && !low.contains(&last), "{low}");
    (0..20).for_each(|_| assert!(screen.press(Key::Char('j'))));
    assert!(text(&screen, (120, 16)).contains(&last), "{}", text(&screen, (120, 16)));
    (0..20).for_each(|_| assert!(screen.press(Key::Char('k'))));
    assert_eq!(text(&screen, (120, 16)), low);
}

#[test]
fn before_a_step_its_outcome_is_asked() {
    let mut screen = Screen::new(sample::walk(), false).with_quiz();
    let press = |screen: &mut Screen, keys: &[Key]| {
        assert!(keys.iter().all(|key| screen.press(*key)), "the screen has ended");
        drawn(screen)
    };
    let answer =
        |text: &str| -> Vec<Key> { text.chars().map(Key::Char).chain([Key::Enter]).collect() };
    let asked = press(&mut screen, &[Key::Right; 3]);
    sample::snapshots().bind(|| insta::assert_snapshot!("screen_quiz_question", asked));
    let judged = press(&mut screen, &answer("3 4 5 6"));
    sample::snapshots().bind(|| insta::assert_snapshot!("screen_quiz_verdict", judged));
    assert!(press(&mut screen, &[Key::Right]).contains(": selection"));
    // What is no answer is asked for again. Wrong, put right; then no answer to the last question,
    // and nothing is asked twice.
    let again = press(&mut screen, &[&[Key::Tab][..], &answer("aa")].concat());
    assert!(again.contains("Enter one number from 1 to 6."), "{again}");
    let crossed = press(&mut screen, &answer("1"));
    assert!(crossed.contains("No: the answer is 3."), "{crossed}");
    assert!(crossed.contains("1 of 2 answers were correct."), "{crossed}");
    let cut = press(&mut screen, &[Key::Right, Key::Right]);
    assert!(cut.contains("Parent a, rank 3, has the genes"), "{cut}");
    press(&mut screen, &[Key::Escape]);
    let mutation = press(&mut screen, &[Key::Right, Key::Tab]);
    assert!(mutation.contains("Does the gene"), "{mutation}");
    let skipped = press(&mut screen, &[Key::Escape, Key::Right]);
    assert!(skipped.contains(": mutation"), "{skipped}");
    assert!(press(&mut screen, &[Key::Left, Key::Right]).contains(": mutation"));
    assert_eq!(screen.score().map(|score| (score.right, score.asked)), Some((1, 2)));
}

#[test]
fn answers_that_do_not_fit_say_why() {
    let last = |keys: &[Key]| shown(keys).lines().last().unwrap_or_default().to_owned();
    assert_eq!(last(&typed('g', "9")), "the generations are 1 to 3");
    assert_eq!(last(&typed('g', "x")), "`x` is not a number");
    assert_eq!(last(&typed('f', "7")), "the individuals are 1 to 6");
    assert_eq!(last(&typed('u', "soon")), "`soon` is not a condition");
    assert_eq!(last(&[Key::Left]), "this is the last step");
    assert_eq!(last(&[Key::Char('g'), Key::Char('2'), Key::Backspace]), "go to generation: _");
}

#[test]
fn an_individual_is_followed() {
    let followed = shown(&[&typed('f', "")[..], &[Key::Down]].concat());
    assert!(followed.contains("followed on as individual 1"), "{followed}");
    assert!(followed.lines().any(|line| line.contains(">♛  1")), "{followed}");
}

#[test]
fn every_individual_can_be_inspected() {
    let inspect = |which: &str| {
        let mut screen = Screen::new(sample::walk(), false);
        let keys = [vec![Key::Right; 2], typed('i', which)].concat();
        assert!(keys.into_iter().all(|key| screen.press(key)), "the screen has ended");
        screen
    };
    // The best is in the trace, as number 6 and by default.
    assert_eq!((inspect("").take_unknown(), inspect("6").take_unknown()), (None, None));
    let mut screen = inspect("4");
    assert_eq!(screen.take_unknown(), Some(screen.walk.generation().genome(3).to_vec()));
    screen.simulated(Ok(vec![2.0, 4.0, 9.0]));
    let text = drawn(&screen);
    sample::snapshots().bind(|| insta::assert_snapshot!("screen_inspect_again", text));
    screen.simulated(Err("no script is at hand".to_owned()));
    assert!(drawn(&screen).contains("no script is at hand"));
}

#[test]
fn the_smallest_terminal_is_no_panic() {
    for (width, height) in [(1, 1), (10, 3), (40, 10), (200, 60)] {
        for keys in [vec![], vec![Key::Char('?')], typed('i', ""), vec![Key::Right; 5]] {
            let mut screen = Screen::new(sample::walk(), true);
            for key in keys {
                screen.press(key);
            }
            let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
            terminal.draw(|frame| draw(&screen, frame)).unwrap();
        }
    }
}

#[test]
fn a_changed_run_is_compared_and_walked_through() {
    let mut screen = Screen::new(sample::walk(), false);
    let press = |screen: &mut Screen, keys: &[Key]| {
        assert!(keys.iter().all(|key| screen.press(*key)), "the screen has ended");
    };
    press(&mut screen, &[&[Key::Down][..], &typed('w', "F_Mut := 1")].concat());
    assert_eq!(screen.take_change(), Some((2, "F_Mut := 1".to_owned())));
    assert_eq!(screen.take_change(), None);
    let changed = Trace::read(&sample::run(3, 54321.0).bytes).unwrap();
    screen.branched(2, "F_Mut := 1".to_owned(), Ok(changed));
    let text = drawn(&screen);
    sample::snapshots().bind(|| insta::assert_snapshot!("screen_what_if", text));
    let verdict = |text: &str| {
        text.lines().find(|line| line.contains("The changed run ends")).map(str::to_owned)
    };
    press(&mut screen, &[Key::Char('x')]);
    assert!(drawn(&screen).starts_with("Generation 2 of 3"));
    // The chart still tells which run is which.
    press(&mut screen, &typed('w', ""));
    assert_eq!(verdict(&drawn(&screen)), verdict(&text));
    screen.branched(2, "F_Mut := 1".to_owned(), Err("it failed".to_owned()));
    assert_eq!(drawn(&screen).lines().last(), Some("it failed"));
}
