use super::*;
use crate::action::Place;
use zfail_plan::glam::DVec3;
use zfail_plan::light::LightKind;

fn session() -> Session {
    Session::new("builtin:room".to_owned(), zfail_builtin::animated("room").expect("it is built in"), Look::default())
}

#[test]
fn the_first_view_is_that_of_the_first_camera() {
    let session = session();
    let scene = zfail_builtin::animated("room").expect("it is built in").scene;
    assert_eq!(session.view([64, 48]), scene.cameras[0].view([64, 48], &scene.bounds()));
}

#[test]
fn after_an_animation_rest_is_what_it_was() {
    let mut session = session();
    let rest = Pose::of(&session.scene);
    session.playback.toggle();
    session.advance(0.7);
    assert!(session.changes.pose && session.changes.picture);
    let moved = Pose::of(&session.scene);
    assert!(moved != rest, "something moves");
    session.advance(0.4);
    session.playback.seconds = Some(0.7);
    session.posed();
    assert!(Pose::of(&session.scene) == moved, "a pose depends on its time alone");
    session.playback.seconds = None;
    session.posed();
    assert!(Pose::of(&session.scene) == rest);
}

#[test]
fn a_light_moved_by_hand_stays_there() {
    let mut session = session();
    let kind = LightKind::Point { position: DVec3::new(0.1, 0.2, 0.3), range: 7.0 };
    session.move_light(1, kind);
    assert!(session.changes.lights);
    session.playback.toggle();
    session.advance(0.3);
    assert_eq!(session.scene.lights[1].kind, kind);
    session.move_light(1, LightKind::Point { position: DVec3::NAN, range: 7.0 });
    assert_eq!(session.scene.lights[1].kind, kind, "what is not finite is refused");
    session.move_light(99, kind);
}

#[test]
fn surroundings_are_switched_and_come_back() {
    let mut session = session();
    let ambient = session.scene.ambient;
    assert!(session.scene.sky.is_none() && session.scene.ground.is_none(), "a built-in scene has none");
    session.set_sky(true);
    session.set_ground(true);
    assert!(session.changes.surroundings && session.changes.picture);
    assert!(session.scene.sky.is_some() && session.scene.ambient == [0.0; 3]);
    assert!(session.scene.ground.is_some_and(|ground| ground.height <= session.bounds().min.y + 1e-9));
    session.move_ground(-7.0);
    session.set_ground(false);
    session.set_ground(true);
    assert_eq!(session.scene.ground.map(|ground| ground.height), Some(-7.0));
    session.move_ground(f64::NAN);
    assert_eq!(session.scene.ground.map(|ground| ground.height), Some(-7.0));
    session.set_sky(false);
    assert_eq!((session.scene.sky, session.scene.ambient), (None, ambient));
}

#[test]
fn a_camera_that_was_made_for_the_scene_follows_the_window() {
    let mut bare = zfail_builtin::animated("anemone").expect("it is built in");
    bare.scene.cameras.clear();
    zfail_scene::Setting::default().complete(&mut bare);
    let mut session = Session::new("anemone.glb".to_owned(), bare, Look::default());
    let place = |session: &Session| session.rig.camera.world_from_view.translation;
    session.fit(1.6);
    let wide = place(&session);
    session.fit(0.5);
    assert_ne!(place(&session), wide);
    session.fit(1.6);
    assert_eq!(place(&session), wide);
    session.posed();
    assert_eq!(place(&session), wide, "a pose leaves it where it is");
    session.rig.turn([0.1, 0.0]);
    let turned = place(&session);
    session.fit(0.7);
    assert_eq!(place(&session), turned, "a camera that was moved by hand stays");
}

#[test]
fn lights_come_and_go() {
    let mut session = session();
    let before = session.scene.lights.len();
    for place in [Place::Eye, Place::Above] {
        session.perform(&Action::AddLight(place));
        assert_eq!(session.selected, Some(session.scene.lights.len() - 1));
        let light = session.scene.lights.last().expect("it was added");
        assert!(light.intensity.is_finite() && light.intensity > 0.0);
    }
    session.advance(1.0);
    session.posed();
    session.perform(&Action::RemoveLight);
    session.perform(&Action::RemoveLight);
    assert_eq!((session.scene.lights.len(), session.selected), (before + 1, None), "only a selected light is removed");
    for _ in 0..=before {
        session.perform(&Action::NextLight);
        session.perform(&Action::RemoveLight);
    }
    session.perform(&Action::NextLight);
    assert_eq!((session.scene.lights.len(), session.selected), (0, None));
}

#[test]
fn shadows_of_a_light_come_back_as_they_were() {
    let mut session = session();
    session.scene.lights[0].excluded = vec![2, 5];
    session.set_light_casts(0, false);
    assert!(!session.light_casts(0));
    session.set_light_casts(0, false);
    session.set_light_casts(0, true);
    assert_eq!(session.scene.lights[0].excluded, [2, 5]);
}

#[test]
fn what_did_not_change_is_not_marked() {
    let mut session = session();
    session.changes = Changes::default();
    session.set_casting(0, session.scene.instances[0].casts_shadow);
    session.set_light_casts(0, true);
    session.advance(1.0);
    assert_eq!(session.changes, Changes::default());
    session.set_casting(0, !session.scene.instances[0].casts_shadow);
    assert_eq!(session.changes, Changes { casting: true, picture: true, ..Changes::default() });
    assert!(!session.perform(&Action::Quit), "that is the window's business");
}

#[test]
fn overlays_keep_their_order() {
    let mut look = Look::default();
    for overlay in [Overlay::Stencil, Overlay::Volumes, Overlay::Wireframe, Overlay::Stencil] {
        look.toggle(overlay);
    }
    assert_eq!(look.overlays, [Overlay::Volumes, Overlay::Wireframe]);
}
